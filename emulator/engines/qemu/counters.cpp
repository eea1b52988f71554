// SPDX-License-Identifier: MIT
// Which instructions read counters, and the one function of QEMU beyond its plugin interface that we call.
#include "emulator/engines/qemu/counters.hpp"

#include <bit>

// QEMU 7.2, include/hw/core/cpu.h and target/riscv/gdbstub.c. Builds with modules, as Debian's, export all functions;
// in others these are null.
extern "C" {
struct CPUState;
__attribute__((weak)) CPUState* qemu_get_cpu(int index);
__attribute__((weak)) int riscv_cpu_gdb_write_register(CPUState* cpu, std::uint8_t* little_endian, int number);
}

namespace torolux {

std::optional<CounterRead> counter_read(std::uint32_t instruction) {
  constexpr std::uint32_t kSystem = 0x73;
  constexpr std::uint32_t kHighHalf = 0x80;
  const std::uint32_t kind = instruction >> 12U & 7U;     // 2: csrrs, 3: csrrc, 6: csrrsi, 7: csrrci
  const std::uint32_t source = instruction >> 15U & 31U;  // register or bits; 0: nothing is written
  if ((instruction & 0x7FU) != kSystem || (kind & 2U) == 0 || source != 0) return std::nullopt;
  const std::uint32_t number = instruction >> 20U;
  const bool high = (number & kHighHalf) != 0;
  const unsigned destination = instruction >> 7U & 31U;
  switch (number & ~kHighHalf) {
    case 0xB00:  // mcycle
    case 0xC00:  // cycle
    case 0xC01:  // time
      return CounterRead{CounterRead::Of::clock, high, destination};
    case 0xB02:  // minstret
    case 0xC02:  // instret
      return CounterRead{CounterRead::Of::instructions, high, destination};
    default:
      return std::nullopt;
  }
}

bool set_register(unsigned number, std::uint32_t value) {
  if (qemu_get_cpu == nullptr || riscv_cpu_gdb_write_register == nullptr) return false;
  static_assert(std::endian::native == std::endian::little);
  riscv_cpu_gdb_write_register(qemu_get_cpu(0), reinterpret_cast<std::uint8_t*>(&value), static_cast<int>(number));
  return true;
}

}  // namespace torolux
