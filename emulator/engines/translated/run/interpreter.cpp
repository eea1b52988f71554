// SPDX-License-Identifier: MIT
// Fetches, counts and executes one instruction; memory is in interpreter_memory.cpp, arithmetic in arithmetic.cpp.
#include "emulator/engines/translated/run/interpreter.hpp"

#include "emulator/engines/translated/run/arithmetic.hpp"

namespace torolux::translated {
namespace {

constexpr std::uint32_t kInstructionBytes = 2;  // of the smallest

bool is_taken(const Instruction& i, std::uint32_t a, std::uint32_t b) {
  switch (i.op) {
    case Op::beq:
      return a == b;
    case Op::bne:
      return a != b;
    case Op::blt:
      return static_cast<std::int32_t>(a) < static_cast<std::int32_t>(b);
    case Op::bge:
      return static_cast<std::int32_t>(a) >= static_cast<std::int32_t>(b);
    case Op::bltu:
      return a < b;
    default:
      return a >= b;
  }
}

void jump(TranslatedPe& pe, const Instruction& i) {
  const std::uint32_t target = i.op == Op::jal ? pe.pc + i.immediate : (pe.x[i.rs1] + i.immediate) & ~1U;
  pe.x[i.rd] = pe.pc + i.bytes;
  pe.pc = target;
}

/// False: illegal.
bool access_csr(TranslatedPe& pe, const Instruction& i) {
  const bool from_immediate = i.op >= Op::csrrwi;
  const std::uint32_t operand = from_immediate ? i.rs1 : pe.x[i.rs1];
  const bool replaces = i.op == Op::csrrw || i.op == Op::csrrwi;
  const auto old = read_csr(pe, i.immediate);
  if (!old) return false;
  // As in QEMU, setting or clearing no bits writes nothing, whatever register the mask came from.
  if (replaces || operand != 0) {
    const bool sets = i.op == Op::csrrs || i.op == Op::csrrsi;
    const std::uint32_t value = replaces ? operand : sets ? *old | operand : *old & ~operand;
    if (!write_csr(pe, i.immediate, value)) return false;
  }
  pe.x[i.rd] = *old;
  return true;
}

}  // namespace

Interpreter::Step Interpreter::trap(TranslatedPe& pe, Cause cause, std::uint32_t value) const {
  const bool in_vain = cause == Cause::fetch_access && (pe.pc == (pe.mtvec & ~3U));
  if (in_vain) return Step::stuck;
  raise(pe, cause, value);
  return Step::done;
}

bool Interpreter::may_fetch(const TranslatedPe& pe, std::uint32_t address) const {
  return code_.holds_code(address, kInstructionBytes) && pmp_allows(pe, address, kInstructionBytes, Access::fetch);
}

Interpreter::Step Interpreter::step(TranslatedPe& pe) const {
  const PlacedInstruction* placed = code_.at(pe.pc);
  if (placed == nullptr || !may_fetch(pe, pe.pc)) {
    const bool first_half = placed == nullptr && may_fetch(pe, pe.pc);
    return trap(pe, Cause::fetch_access, first_half ? pe.pc + kInstructionBytes : pe.pc);
  }
  if (placed->instruction.bytes == 4 && !may_fetch(pe, pe.pc + kInstructionBytes)) {
    return trap(pe, Cause::fetch_access, pe.pc + kInstructionBytes);
  }
  pe.cycles += placed->cost.cycles;
  pe.instructions += placed->cost.instructions;
  const Step step = execute(pe, placed->instruction);
  pe.x[0] = 0;
  return step;
}

Interpreter::Step Interpreter::execute(TranslatedPe& pe, const Instruction& i) const {
  const auto illegal = [&] { return trap(pe, Cause::illegal_instruction, i.bits); };
  if (is_float(i.op) && float_is_off(pe)) return illegal();
  if (is_branch(i.op)) {
    pe.pc += is_taken(i, pe.x[i.rs1], pe.x[i.rs2]) ? i.immediate : i.bytes;
    return Step::done;
  }
  if ((i.op >= Op::lb && i.op <= Op::amomaxu)) {
    const MaybeFault fault = i.op <= Op::fsw ? memory(pe, i) : atomic(pe, i);
    if (fault) return trap(pe, fault->cause, fault->value);
    pe.pc += i.bytes;
    return Step::done;
  }
  switch (i.op) {
    case Op::jal:
    case Op::jalr:
      jump(pe, i);
      return Step::done;
    case Op::ecall:
      return trap(pe, Cause::machine_call, 0);
    case Op::ebreak:
      return trap(pe, Cause::breakpoint, 0);
    case Op::mret:
      return return_from_trap(pe) ? Step::done : illegal();
    case Op::wfi:
      return Step::waits;
    case Op::illegal:
      return illegal();
    default:
      break;
  }
  const bool works = is_csr(i.op) ? access_csr(pe, i) : is_float(i.op) ? compute_float(pe, i) : compute_integer(pe, i);
  if (!works) return illegal();
  pe.pc += i.bytes;
  if (i.op != Op::hint) return Step::done;
  pe.hint_immediate = static_cast<std::int32_t>(i.immediate);
  return Step::hint;
}

}  // namespace torolux::translated
