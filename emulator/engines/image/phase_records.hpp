// SPDX-License-Identifier: MIT
// The section .torolux.phases of an image enters; the names of its phases leave.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "emulator/phase_names.hpp"

namespace torolux {

inline constexpr const char* kPhaseSection = ".torolux.phases";
/// A record: the phase's number, 32 bits, little endian; then its name, ended by a zero byte.
inline constexpr std::size_t kPhaseRecordBytes = 28;
inline constexpr std::size_t kMostPhaseNameBytes = kPhaseRecordBytes - sizeof(std::uint32_t) - 1;

struct PhaseRecords {
  PhaseNames names;
  std::string wrong;  ///< empty: nothing. Otherwise what, as in "names phase 3 twice"
};

/// What has no record has no name, but for Phase::program, which start-up code enters. Names are UTF-8 without control
/// characters, 1 to kMostPhaseNameBytes long, and differ from each other and from "outside".
PhaseRecords read_phase_records(std::span<const std::byte> section);

}  // namespace torolux
