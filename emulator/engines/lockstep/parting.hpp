// SPDX-License-Identifier: MIT
// Where between two HINTs translated code parts from the interpreter. Enters: a PE's state after a HINT; leaves: the
// last place at which both were the same, to within a few instructions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "emulator/engines/translated/decode/code_map.hpp"
#include "emulator/engines/translated/run/translated_image.hpp"

namespace torolux::lockstep {

struct Parting {
  struct Place {
    std::uint32_t pc;
    std::uint64_t clock;
  };
  Place same;                         ///< here they agreed for the last time
  Place translated, interpreted;      ///< and here, shortly after, no more
  std::optional<std::uint32_t> byte;  ///< offset of the first byte of local memory that differs there
};

/// Nothing where both come to the next HINT, or get stuck, at the same place and clock with the same memory. Registers
/// are not compared: translated code keeps only those that are still read. until: clock at which the search is given
/// up.
std::optional<Parting> find_parting(const translated::TranslatedImage& code, const translated::CodeMap& map,
                                    const translated::TranslatedPe& start, std::span<const std::byte> memory,
                                    std::uint64_t until);

}  // namespace torolux::lockstep
