// SPDX-License-Identifier: MIT
// The profiles of PEs enter; cycles and calls of each function leave.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/profile/paths.hpp"

namespace torolux {

/// Own cycles of one PE, over PEs.
struct Spread {
  std::uint64_t least = 0, most = 0;
  unsigned least_pe = 0, most_pe = 0;  ///< the first of those
  double mean = 0;
};

struct FunctionTotals {
  NameNumber name;          ///< or a wait's
  std::uint64_t calls = 0;  ///< of a wait: 0
  std::uint64_t self = 0;   ///< [cycles] executing its own instructions; of a wait: waiting
  std::uint64_t waits = 0;  ///< [cycles] waiting in HINTs that it executed itself
  std::uint64_t total = 0;  ///< [cycles] with all that it has called and waited; what recursion calls counts once
  Spread spread;            ///< of `self`
};

struct ProfileTotals {
  std::vector<FunctionTotals> functions;  ///< all that have been executed, and the waits: by self, the greatest first
  std::uint64_t cycles = 0;               ///< of the PEs, until each had ended
  std::uint64_t waits = 0;                ///< of these; the others were busy
};

/// pes: at least one. tree: theirs.
ProfileTotals totals_of(const profile::CycleProfile& profile, const ProfileNames& names, std::span<const unsigned> pes,
                        const PathTree& tree);

}  // namespace torolux
