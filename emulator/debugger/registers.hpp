// SPDX-License-Identifier: MIT
// A PE's registers as a debugger numbers them: names and numbers of the target description, values by number.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "emulator/engines/engine/registers.hpp"

namespace torolux::debugger {

inline constexpr unsigned kPcNumber = 32;
/// x0 to x31, pc, f0 to f31: what packet `g` holds.
inline constexpr unsigned kGeneralRegisters = 65;

/// XML: features org.gnu.gdb.riscv.cpu, .fpu and .csr with the names that QEMU gives them, and org.torolux.pe with
/// `clock` and `instructions`, of 64 bits, which can only be read.
std::string target_description();

/// Hexadecimal, the lowest byte first. Nothing: there is no such register.
std::optional<std::string> register_text(const PeRegisters& registers, unsigned number);
/// False: there is none, the text is no value, or it can only be read.
bool set_register(PeRegisters& registers, unsigned number, std::string_view text);

}  // namespace torolux::debugger
