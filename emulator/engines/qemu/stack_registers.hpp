// SPDX-License-Identifier: MIT
// QEMU's registers by which calls are found. Leaves: their values; for the plugin alone.
#pragma once

#include <array>
#include <cstdint>

namespace torolux {

/// Those in kStackRegisters, from a callback at the start of a block: then QEMU has all registers in memory. False:
/// this QEMU does not export what is needed, which is no part of its plugin interface.
bool read_stack_registers(std::array<std::uint32_t, 32>& x);

}  // namespace torolux
