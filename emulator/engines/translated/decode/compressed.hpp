// SPDX-License-Identifier: MIT
// Compressed instructions: 16 bits in, the fields of the instruction that they stand for out.
#pragma once

#include "emulator/engines/translated/decode/instruction.hpp"

namespace torolux::translated {

/// out.bits: a valid compressed instruction (RISC-V Instruction Set Manual, volume I, 20191213, chapter 16). Sets the
/// operation, registers and immediate.
void decode_compressed(Instruction& out);

}  // namespace torolux::translated
