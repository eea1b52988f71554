// SPDX-License-Identifier: MIT
// One PE: registers here, everything else in the memory that it shares with the emulator.
#include "emulator/engines/translated/run/processor.hpp"

#include <algorithm>
#include <cstring>

#include "emulator/niu/channel.hpp"
#include "emulator/niu/ending.hpp"
#include "emulator/profile/cycle_profile.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux::translated {
namespace {

/// A PE that meets no HINT runs so many cycles, about a millisecond, before others have their turn.
constexpr std::uint64_t kSliceCycles = 1U << 20U;

std::span<std::byte> local_memory(const EngineSetup& setup, unsigned number) {
  const PeMemory& memory = setup.pes[number];
  return memory.local.bytes().first(memory.local_memory_bytes);
}

/// copy: called with each register of the PE and the same one as it is saved.
template <class Pe, class Registers, class Copy>
void copy_registers(Pe& pe, Registers& saved, Copy copy) {
  static_assert(sizeof pe.x == sizeof saved.x && sizeof pe.f == sizeof saved.f);
  static_assert(sizeof pe.pmpaddr == sizeof saved.pmpaddr && sizeof pe.pmpcfg == sizeof saved.pmpcfg);
  copy(pe.x, saved.x);
  copy(pe.f, saved.f);
  copy(pe.pc, saved.pc);
  copy(pe.fflags, saved.fflags);
  copy(pe.frm, saved.frm);
  copy(pe.mstatus, saved.mstatus);
  copy(pe.mstatush, saved.mstatush);
  copy(pe.mtvec, saved.mtvec);
  copy(pe.mscratch, saved.mscratch);
  copy(pe.mepc, saved.mepc);
  copy(pe.mcause, saved.mcause);
  copy(pe.mtval, saved.mtval);
  copy(pe.mie, saved.mie);
  copy(pe.mip, saved.mip);
  copy(pe.pmpaddr, saved.pmpaddr);
  copy(pe.pmpcfg, saved.pmpcfg);
  copy(pe.reserved_address, saved.reserved_address);
  copy(pe.reserved_value, saved.reserved_value);
}

// What a PE takes besides local memory: this, and of its channel in a machine of many PEs some 55 KiB.
static_assert(sizeof(Processor) <= 2048);

}  // namespace

Processor::Processor(const TranslatedImage& code, const EngineSetup& setup, unsigned number)
    : code_(code),
      channel_(*niu_channel_at(setup.pes[number].channel.bytes().data())),
      niu_(channel_, local_memory(setup, number), setup.images.of(number).niu_window - protocol::kLocalMemoryBase,
           NiuProcessorSide::Waiting::returns),
      profile_(setup.profile == nullptr ? nullptr : &setup.profile->pe(number)) {
  code_.start(pe_, local_memory(setup, number), mapped_bytes_for(setup.pes[number].local_memory_bytes));
  pe_.marker = &Processor::marker;
  pe_.hint = &Processor::hint;
  pe_.context = this;
}

void Processor::marker(void* processor, std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions) {
  // A marker that is wrong stops the NIU: the next HINT says so.
  static_cast<Processor*>(processor)->niu_.hint(immediate, clock, instructions);
}

/// From translated code. True: it has happened, and the PE goes on at once.
bool Processor::hint(void* processor, std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions) {
  auto& self = *static_cast<Processor*>(processor);
  self.at_hint_ = self.ask(immediate, clock, instructions);
  self.asked_ = self.at_hint_ != AtHint::none || (self.goal_ != nullptr && self.goal_->reached());
  return !self.asked_;
}

/// What the HINT waited is added to the PE's clock. It is no work, so the slice ends later.
Processor::AtHint Processor::ask(std::int32_t immediate, std::uint64_t clock, std::uint64_t instructions) {
  const NiuProcessorSide::Result result = niu_.hint(immediate, clock, instructions);
  switch (result.outcome) {
    case NiuProcessorSide::Outcome::retry:
      return AtHint::waits;
    case NiuProcessorSide::Outcome::stop:
      return AtHint::finished;
    case NiuProcessorSide::Outcome::done:
      break;
  }
  pe_.cycles += result.clock - clock;
  pe_.cycle_limit += result.clock - clock;
  if (profile_ != nullptr) profile_->waited(waits());
  return AtHint::none;
}

WaitCycles Processor::waits() const {
  WaitCycles waits{};
  for (std::size_t i = 0; i < kWaitReasons; ++i) waits[i] = channel_.waits[i].load(std::memory_order_relaxed);
  return waits;
}

TranslatedImage::Stop Processor::execute() {
  if (profile_ == nullptr) return code_.run(pe_);
  if (!profile_->has_begun()) profile_->begin({pe_.pc, pe_.x[2], pe_.cycles}, waits());
  const TranslatedImage::Stop stop = code_.run_profiled(pe_, *profile_);
  profile_->charge(pe_.cycles);
  return stop;
}

/// Whether it has run for longer without a HINT than the machine allows.
bool Processor::loops() const {
  return pe_.cycles >= end_of_patience(channel_);
}

Processor::Stop Processor::give_up(const NiuFault& fault) {
  fault_ = fault;
  return end();
}

Processor::Stop Processor::give_up_stuck() {
  return give_up({NiuFaultCode::no_trap_handler, {pe_.mcause, pe_.mepc, pe_.mtval}});
}

Processor::Stop Processor::give_up_waiting() {
  return give_up({NiuFaultCode::wait_for_interrupt, {pe_.pc, 0, 0}});
}

/// Its turn comes again where the network has no room for this yet.
Processor::Stop Processor::end() {
  const bool loop = fault_->code == NiuFaultCode::too_long_without_hint;
  const std::uint64_t clock = loop ? end_of_patience(channel_) : pe_.cycles;
  return end_with_fault(channel_, clock, *fault_) ? Stop::finished : Stop::slice;
}

PeRegisters Processor::save() const {
  PeRegisters registers{};
  registers.clock = pe_.cycles;
  registers.instructions = pe_.instructions;
  registers.hint_immediate = pe_.hint_immediate;
  registers.halted = at_hint_ == AtHint::finished ? 1 : at_hint_ == AtHint::none ? kStandsBetween : 0;
  copy_registers(pe_, registers, [](const auto& of_pe, auto& saved) { std::memcpy(&saved, &of_pe, sizeof saved); });
  return registers;
}

StackRegisters Processor::stack_registers() const {
  constexpr std::uint32_t kHintBytes = 4;
  const bool behind_hint = at_hint_ != AtHint::none && !fault_;
  StackRegisters registers{pe_.pc - (behind_hint ? kHintBytes : 0), {}};
  static_assert(sizeof pe_.x == sizeof registers.x);
  std::memcpy(registers.x.data(), pe_.x, sizeof pe_.x);
  return registers;
}

void Processor::restore(const PeRegisters& registers) {
  pe_.cycles = registers.clock;
  pe_.instructions = registers.instructions;
  pe_.hint_immediate = registers.hint_immediate;
  at_hint_ = registers.halted == kStandsBetween ? AtHint::none
             : registers.halted != 0            ? AtHint::finished
                                                : AtHint::waits;
  copy_registers(pe_, registers, [](auto& of_pe, const auto& saved) { std::memcpy(&of_pe, &saved, sizeof saved); });
  code_.resume(pe_);
}

Processor::Stop Processor::run(const Goal* goal) {
  if (fault_) return end();
  goal_ = goal;
  // A loop ends at the same instruction, whoever ran it how often.
  pe_.cycle_limit = std::min(pe_.cycles + kSliceCycles, std::max(end_of_patience(channel_), pe_.cycles + 1));
  if (at_hint_ == AtHint::waits) at_hint_ = AtHint::reached;
  for (;;) {
    if (at_hint_ == AtHint::reached) at_hint_ = ask(pe_.hint_immediate, pe_.cycles, pe_.instructions);
    if (at_hint_ == AtHint::waits) return Stop::waits;
    if (at_hint_ == AtHint::finished) return Stop::finished;
    if (goal != nullptr && goal->reached()) return Stop::enough;
    asked_ = false;
    switch (execute()) {
      case TranslatedImage::Stop::hint:
        if (!asked_) at_hint_ = AtHint::reached;
        break;
      case TranslatedImage::Stop::cycle_limit:
        return loops() ? give_up(endless_loop(channel_, pe_.pc)) : Stop::slice;
      case TranslatedImage::Stop::stuck:
        return give_up_stuck();
      case TranslatedImage::Stop::waits:
        return give_up_waiting();
    }
  }
}

Processor::Stop Processor::step() {
  if (fault_) return end();
  if (at_hint_ == AtHint::none) {
    switch (code_.step(pe_).value_or(TranslatedImage::Stop::cycle_limit)) {
      case TranslatedImage::Stop::hint:
        at_hint_ = AtHint::reached;
        break;
      case TranslatedImage::Stop::cycle_limit:
        if (loops()) return give_up(endless_loop(channel_, pe_.pc));
        break;
      case TranslatedImage::Stop::stuck:
        return give_up_stuck();
      case TranslatedImage::Stop::waits:
        return give_up_waiting();
    }
  }
  if (at_hint_ == AtHint::waits) at_hint_ = AtHint::reached;
  if (at_hint_ == AtHint::reached) at_hint_ = ask(pe_.hint_immediate, pe_.cycles, pe_.instructions);
  if (at_hint_ == AtHint::waits) return Stop::waits;
  if (at_hint_ == AtHint::finished) return Stop::finished;
  // Its clock is its bound: so the scheduler gives it its turn in the order of virtual time.
  const std::uint64_t bound = pe_.cycles + kCommandCycles;
  if (channel_.bound.load(std::memory_order_relaxed) < bound) channel_.bound.store(bound, std::memory_order_release);
  return Stop::slice;
}

}  // namespace torolux::translated
