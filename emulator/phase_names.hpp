// SPDX-License-Identifier: MIT
// What a program calls its phases: numbers enter, names leave.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>

#include "firmware/protocol/hints.hpp"

namespace torolux {

/// By number; empty: the program has no name for it.
using PhaseNames = std::array<std::string, protocol::kPhases>;

/// Of Torolux's own programs, and of all that name none.
inline PhaseNames built_in_phase_names() {
  PhaseNames names;
  std::copy(protocol::kPhaseNames.begin(), protocol::kPhaseNames.end(), names.begin());
  return names;
}

/// number: 0 to kPhases - 1. One without a name is called by its number.
inline std::string phase_name(const PhaseNames& names, std::size_t number) {
  return names[number].empty() ? "phase_" + std::to_string(number) : names[number];
}

}  // namespace torolux
