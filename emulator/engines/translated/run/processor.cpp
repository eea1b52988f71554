// SPDX-License-Identifier: MIT
// One PE: registers here, everything else in the memory that it shares with the emulator.
#include "emulator/engines/translated/run/processor.hpp"

#include <algorithm>

#include "emulator/niu/channel.hpp"
#include "emulator/niu/ending.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux::translated {
namespace {

/// A PE that meets no HINT runs so many cycles, about a millisecond, before others have their turn.
constexpr std::uint64_t kSliceCycles = 1U << 20U;

std::span<std::byte> local_memory(const EngineSetup& setup, unsigned number) {
  const PeMemory& memory = setup.pes[number];
  return memory.local.bytes().first(memory.local_memory_bytes);
}

// What a PE takes besides local memory: this, and of its channel in a machine of many PEs some 55 KiB.
static_assert(sizeof(Processor) <= 2048);

}  // namespace

Processor::Processor(const TranslatedImage& code, const EngineSetup& setup, unsigned number)
    : code_(code),
      channel_(*niu_channel_at(setup.pes[number].channel.bytes().data())),
      niu_(channel_, local_memory(setup, number), setup.image.niu_window - protocol::kLocalMemoryBase,
           NiuProcessorSide::Waiting::returns) {
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
  return AtHint::none;
}

/// Whether it has run for longer without a HINT than the machine allows.
bool Processor::loops() const {
  return pe_.cycles >= end_of_patience(channel_);
}

Processor::Stop Processor::give_up(const NiuFault& fault) {
  fault_ = fault;
  return end();
}

/// Its turn comes again where the network has no room for this yet.
Processor::Stop Processor::end() {
  const bool loop = fault_->code == NiuFaultCode::too_long_without_hint;
  const std::uint64_t clock = loop ? end_of_patience(channel_) : pe_.cycles;
  return end_with_fault(channel_, clock, *fault_) ? Stop::finished : Stop::slice;
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
    switch (code_.run(pe_)) {
      case TranslatedImage::Stop::hint:
        if (!asked_) at_hint_ = AtHint::reached;
        break;
      case TranslatedImage::Stop::cycle_limit:
        return loops() ? give_up(endless_loop(channel_, pe_.pc)) : Stop::slice;
      case TranslatedImage::Stop::stuck:
        return give_up({NiuFaultCode::no_trap_handler, {pe_.mcause, pe_.mepc, pe_.mtval}});
      case TranslatedImage::Stop::waits:
        return give_up({NiuFaultCode::wait_for_interrupt, {pe_.pc, 0, 0}});
    }
  }
}

}  // namespace torolux::translated
