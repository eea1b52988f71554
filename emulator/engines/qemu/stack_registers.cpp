// SPDX-License-Identifier: MIT
// As QEMU gives them to a debugger.
#include "emulator/engines/qemu/stack_registers.hpp"

#include <cstring>

#include "emulator/engines/engine/registers.hpp"

// QEMU 7.2, include/hw/core/cpu.h and target/riscv/gdbstub.c, and GLib's arrays of bytes, which it is given. Builds
// with modules, as Debian's, export all functions; in others these are null.
extern "C" {
struct CPUState;
struct GByteArray {
  std::uint8_t* data;
  unsigned len;
};
__attribute__((weak)) CPUState* qemu_get_cpu(int index);
__attribute__((weak)) int riscv_cpu_gdb_read_register(CPUState* cpu, GByteArray* bytes, int number);
__attribute__((weak)) GByteArray* g_byte_array_new();
__attribute__((weak)) GByteArray* g_byte_array_set_size(GByteArray* array, unsigned bytes);
}

namespace torolux {

bool read_stack_registers(std::array<std::uint32_t, 32>& x) {
  if (qemu_get_cpu == nullptr || riscv_cpu_gdb_read_register == nullptr || g_byte_array_new == nullptr ||
      g_byte_array_set_size == nullptr) {
    return false;
  }
  static GByteArray* const bytes = g_byte_array_new();  // QEMU's; there is one processor
  CPUState* const cpu = qemu_get_cpu(0);
  for (unsigned number = 1; number < x.size(); ++number) {
    if ((kStackRegisters >> number & 1U) == 0) continue;
    g_byte_array_set_size(bytes, 0);
    if (riscv_cpu_gdb_read_register(cpu, bytes, static_cast<int>(number)) != sizeof x[number]) return false;
    std::memcpy(&x[number], bytes->data, sizeof x[number]);
  }
  return true;
}

}  // namespace torolux
