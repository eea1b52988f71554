// SPDX-License-Identifier: MIT
// What a stage was, as the host saw it: rounds of the radiosity stage, subspaces visited by path segments.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "emulator/host/host_program.hpp"
#include "firmware/protocol/records.hpp"

namespace torolux {

/// Times by the host's clock: begin (selection) <= chosen (shots begin) <= last_shot_done <= end (all credits home).
struct RoundFigures {
  Cycles begin = 0, chosen = 0, last_shot_done = 0, end = 0;
  std::uint32_t shooters = 0;  ///< shots
  std::uint32_t pes = 0;       ///< that shoot
  std::uint64_t records = 0;   ///< that the shots made
  double unshot = 0;           ///< of the emitted flux, at the selection

  Cycles tail() const { return end - last_shot_done; }  ///< no more records are made, the last ones end
};

/// [n]: path segments that went through n subspaces; the last entry: or more.
using VisitSums = std::array<std::uint64_t, protocol::kMostVisits + 1>;

}  // namespace torolux
