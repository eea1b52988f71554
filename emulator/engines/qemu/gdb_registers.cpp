// SPDX-License-Identifier: MIT
// Numbers of registers as QEMU 7.2 gives them to a debugger, and the way to the next HINT.
#include "emulator/engines/qemu/gdb_registers.hpp"

#include <array>
#include <cstring>
#include <optional>

#include "emulator/errors.hpp"
#include "firmware/protocol/hints.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {
namespace {

constexpr unsigned kPc = 32, kFirstFloat = 33;
/// Control and status register 0. Between the f registers and these stands one for the privilege.
constexpr unsigned kFirstCsr = 66;
constexpr unsigned kMisa = 0x301, kPmpcfg0 = 0x3A0, kPmpaddr0 = 0x3B0;
constexpr std::uint32_t kMisaValue = 0x4000'1125;  // RV32, A C F I M
/// The driver's loop takes a few dozen instructions.
constexpr int kMostSteps = 10'000;
constexpr unsigned kWord = 4;

/// Plain ones, in the order in which they may be set.
template <class Registers, class Each>
void each_csr(Registers& registers, Each each) {
  each(0x300U, registers.mstatus);
  each(0x310U, registers.mstatush);
  each(0x001U, registers.fflags);
  each(0x002U, registers.frm);
  each(0x305U, registers.mtvec);
  each(0x340U, registers.mscratch);
  each(0x341U, registers.mepc);
  each(0x342U, registers.mcause);
  each(0x343U, registers.mtval);
  each(0x304U, registers.mie);
  each(0x344U, registers.mip);
  // Addresses first: what is locked cannot be moved.
  for (unsigned i = 0; i < kProtectedRegions; ++i) each(kPmpaddr0 + i, registers.pmpaddr[i]);
}

void check_numbers(GdbConnection& qemu) {
  qemu.ask("qXfer:features:read:target.xml:0,40");  // only who has asked this may read one register
  if (qemu.read(kFirstCsr + kMisa) != kMisaValue)
    throw MachineFailure(
        "this QEMU numbers its registers otherwise than 7.2, so its PEs cannot be saved; use `--engine "
        "translated`");
}

/// What stands at pc, if it is a HINT that may wait.
std::optional<std::int32_t> hint_at(std::uint32_t pc, std::span<const std::byte> memory) {
  const std::uint64_t at = std::uint64_t{pc} - protocol::kLocalMemoryBase;
  if (pc < protocol::kLocalMemoryBase || at + kWord > memory.size()) return std::nullopt;
  std::uint32_t bits = 0;
  std::memcpy(&bits, memory.data() + at, sizeof bits);
  if (!protocol::is_hint(bits)) return std::nullopt;
  const std::int32_t immediate = protocol::hint_immediate(bits);
  return protocol::is_phase_marker(immediate) ? std::nullopt : std::optional(immediate);
}

}  // namespace

PeRegisters read_registers_behind_hint(GdbConnection& qemu, std::span<const std::byte> memory) {
  check_numbers(qemu);
  PeRegisters registers{};
  std::optional<std::int32_t> hint;
  for (int step = 0; !hint; ++step) {
    if (step == kMostSteps) throw MachineFailure("a PE that is to be saved does not repeat its HINT");
    hint = hint_at(qemu.read(kPc), memory);
    qemu.step();
  }
  registers.hint_immediate = *hint;
  registers.pc = qemu.read(kPc);
  for (unsigned i = 0; i < registers.x.size(); ++i) registers.x[i] = qemu.read(i);
  for (unsigned i = 0; i < registers.f.size(); ++i) registers.f[i] = qemu.read(kFirstFloat + i);
  each_csr(registers, [&](unsigned number, std::uint32_t& value) { value = qemu.read(kFirstCsr + number); });
  for (unsigned i = 0; i < kProtectedRegions; i += kWord) {
    const std::uint32_t four = qemu.read(kFirstCsr + kPmpcfg0 + i / kWord);
    std::memcpy(&registers.pmpcfg[i], &four, sizeof four);
  }
  registers.reserved_address = 0xFFFF'FFFF;
  return registers;
}

void write_registers(GdbConnection& qemu, const PeRegisters& registers) {
  check_numbers(qemu);
  for (unsigned i = 1; i < registers.x.size(); ++i) qemu.write(i, registers.x[i]);
  each_csr(registers, [&](unsigned number, std::uint32_t value) { qemu.write(kFirstCsr + number, value); });
  for (unsigned i = 0; i < registers.f.size(); ++i) qemu.write(kFirstFloat + i, registers.f[i]);
  for (unsigned i = 0; i < kProtectedRegions; i += kWord) {
    std::uint32_t four = 0;
    std::memcpy(&four, &registers.pmpcfg[i], sizeof four);
    qemu.write(kFirstCsr + kPmpcfg0 + i / kWord, four);
  }
  qemu.write(kPc, registers.pc);
}

}  // namespace torolux
