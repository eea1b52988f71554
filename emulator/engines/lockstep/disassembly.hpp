// SPDX-License-Identifier: MIT
// An instruction enters; a line for people leaves: "lw a0, 4(sp)". Compressed ones as what they stand for.
#pragma once

#include <cstdint>
#include <string>

#include "emulator/engines/translated/decode/instruction.hpp"

namespace torolux::lockstep {

/// pc: where it stands, for the targets of jumps.
std::string disassemble(const translated::Instruction& instruction, std::uint32_t pc);

}  // namespace torolux::lockstep
