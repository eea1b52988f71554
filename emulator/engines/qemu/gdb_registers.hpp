// SPDX-License-Identifier: MIT
// A stopped PE's registers by its QEMU's debugger stub.
#pragma once

#include <cstddef>
#include <span>

#include "emulator/engines/engine/registers.hpp"
#include "emulator/engines/qemu/gdb_connection.hpp"

namespace torolux {

/// Steps a stopped PE, which goes round its NIU driver's loop, to behind the HINT that it repeats, and reads all but
/// clock and instructions. memory: the PE's. Throws MachineFailure.
PeRegisters read_registers_behind_hint(GdbConnection& qemu, std::span<const std::byte> memory);

/// All but clock and instructions.
void write_registers(GdbConnection& qemu, const PeRegisters& registers);

}  // namespace torolux
