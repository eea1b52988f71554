// SPDX-License-Identifier: MIT
// Interpreted, one instruction at a time; what it is going to do is read from the decoded code.
#include "emulator/engines/translated/run/lent_processor.hpp"

#include "firmware/protocol/machine.hpp"

namespace torolux::translated {
namespace {

constexpr std::uint32_t kHintBytes = 4;

class LentProcessor final : public DebuggedPe {
 public:
  explicit LentProcessor(Processor& processor) : processor_(processor) {}

  Standing standing() const override {
    return processor_.has_ended() ? Standing::ended : processor_.waits_in_hint() ? Standing::waits : Standing::between;
  }
  Step step(bool stops_at_trap) override;
  std::uint64_t clock() const override { return processor_.state().cycles; }
  std::uint32_t pc() const override { return processor_.state().pc - (standing() == Standing::waits ? kHintBytes : 0); }
  PeRegisters registers() const override {
    PeRegisters registers = processor_.save();
    registers.pc = pc();
    return registers;
  }
  void set_registers(const PeRegisters& registers) override {
    PeRegisters all = registers;
    const TranslatedPe& now = processor_.state();
    all.clock = now.cycles;
    all.instructions = now.instructions;
    all.hint_immediate = now.hint_immediate;
    all.halted = kStandsBetween;
    all.x[0] = 0;
    processor_.restore(all);
  }
  std::span<std::byte> memory() override {
    const TranslatedPe& pe = processor_.state();
    return {pe.memory, pe.memory_bytes};
  }
  bool is_code(std::uint32_t address, std::uint32_t bytes) const override {
    return processor_.code().code().holds_code(address, bytes);
  }
  std::optional<MemoryAccess> next_access() const override;
  std::optional<std::int32_t> next_hint() const override {
    const Instruction* const next = next_instruction();
    if (next == nullptr || next->op != Op::hint) return std::nullopt;
    return static_cast<std::int32_t>(next->immediate);
  }
  std::uint32_t trap_cause() const override { return trap_cause_; }

 private:
  const Instruction* next_instruction() const {
    const PlacedInstruction* const placed = processor_.code().code().at(pc());
    return placed != nullptr ? &placed->instruction : nullptr;
  }

  Processor& processor_;
  std::uint32_t trap_cause_ = 0;
};

/// A trap changes registers alone: those are put back.
DebuggedPe::Step LentProcessor::step(bool stops_at_trap) {
  const bool may_trap = stops_at_trap && standing() == Standing::between;
  std::optional<TranslatedPe> before;
  if (may_trap) before = processor_.state();
  const Instruction* const next = next_instruction();
  const bool jumps =
      next != nullptr && (next->op == Op::jal || next->op == Op::jalr || is_branch(next->op) || next->op == Op::mret);
  const Processor::Stop stop = processor_.step();
  if (stop == Processor::Stop::waits) return Step::waits;
  if (stop == Processor::Stop::finished) return Step::ended;
  if (processor_.has_ended()) return Step::waits;  // its last command has no room yet
  const TranslatedPe& after = processor_.state();
  const bool trapped = before && !jumps && after.pc == (after.mtvec & ~3U) && after.mepc == before->pc &&
                       (after.mcause != before->mcause || after.pc != before->pc + (next != nullptr ? next->bytes : 0));
  if (!trapped) return Step::done;
  trap_cause_ = after.mcause;
  processor_.state() = *before;
  return Step::traps;
}

std::optional<MemoryAccess> LentProcessor::next_access() const {
  const Instruction* const next = next_instruction();
  if (next == nullptr || next->op < Op::lb || next->op > Op::amomaxu) return std::nullopt;
  const bool plain = is_access(next->op);
  const bool stores = is_store(next->op);
  const std::uint32_t base = processor_.state().x[next->rs1];
  return MemoryAccess{plain ? base + next->immediate : base, accessed_bytes(next->op),
                      plain ? !stores : next->op != Op::sc, plain ? stores : next->op != Op::lr};
}

}  // namespace

std::unique_ptr<DebuggedPe> lend(Processor& processor) {
  return std::make_unique<LentProcessor>(processor);
}

}  // namespace torolux::translated
