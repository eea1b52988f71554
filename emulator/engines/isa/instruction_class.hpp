// SPDX-License-Identifier: MIT
// From an instruction's bits to its class in the latency table: the same for every engine.
#pragma once

#include <cstdint>
#include <optional>

#include "emulator/description/description.hpp"

namespace torolux {

/// instruction: its bits; of a compressed one the upper half is ignored. Source: The RISC-V Instruction Set Manual,
/// volume I, 20191213, chapters 24 (encodings) and 16 (C). Nothing for what RV32IMAFC_Zicsr_Zifencei does not have.
std::optional<InstructionClass> class_of(std::uint32_t instruction);

/// 2 or 4.
constexpr std::uint32_t bytes_of(std::uint32_t instruction) {
  return (instruction & 3U) == 3U ? 4 : 2;
}

/// A phase marker costs no cycles and does not count as an instruction.
bool is_phase_marker(std::uint32_t instruction);

/// Cycles of an instruction. What the machine lacks costs as much as an integer instruction: it traps.
std::uint32_t cycles_of(std::uint32_t instruction, const LatencyTable& latency);

}  // namespace torolux
