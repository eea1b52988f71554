// SPDX-License-Identifier: MIT
// What instructions compute in registers, for the interpreter: registers and fields in, registers and flags out.
#pragma once

#include "emulator/engines/translated/decode/instruction.hpp"
#include "emulator/engines/translated/semantics/pe_state.hpp"

namespace torolux::translated {

/// i: integer arithmetic, or an instruction that does nothing. False: illegal.
bool compute_integer(TranslatedPe& pe, const Instruction& i);
/// i: floating point, without loads and stores; floating point is on. False: illegal (a reserved rounding mode).
bool compute_float(TranslatedPe& pe, const Instruction& i);

}  // namespace torolux::translated
