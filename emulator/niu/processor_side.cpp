// SPDX-License-Identifier: MIT
// The processor's side of a NIU: HINTs become commands to the network side, arrivals go into local memory. Where the
// answer is already known this takes no system call; otherwise the processor says what it waits for, and sleeps.
#include "emulator/niu/processor_side.hpp"

#include <algorithm>

#include "emulator/niu/channel.hpp"
#include "emulator/niu/hint_run.hpp"
#include "emulator/niu/profile.hpp"
#include "emulator/niu/state_log.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

namespace {

/// Apart, since nobody watches mostly.
[[gnu::noinline, gnu::cold]] void tell_busy(NiuChannel& channel, std::uint64_t clock) {
  state_log_of(channel)->busy_until(channel, clock);
}

}  // namespace

NiuProcessorSide::NiuProcessorSide(NiuChannel& channel, std::span<std::byte> local_memory, std::uint32_t window_offset,
                                   Waiting waiting)
    : channel_(channel), local_memory_(local_memory), window_offset_(window_offset), waiting_(waiting) {}

NiuProcessorSide::Result NiuProcessorSide::hint(std::int32_t immediate, std::uint64_t clock,
                                                std::uint64_t instructions) {
  if (wait_kind(channel_.wait.load(std::memory_order_relaxed)) == WaitKind::halted ||
      channel_.stopping.load(std::memory_order_relaxed) != 0) {
    return {Outcome::stop, clock};
  }
  channel_.instructions.store(instructions, std::memory_order_relaxed);
  return protocol::is_phase_marker(immediate) ? mark(immediate, clock) : happen(immediate, clock);
}

NiuProcessorSide::Result NiuProcessorSide::mark(std::int32_t immediate, std::uint64_t clock) {
  if (channel_.state_log != 0) tell_busy(channel_, clock);
  if (!mark_phase(channel_, immediate, clock)) {
    report_mismatch(channel_, static_cast<std::uint8_t>(immediate % 64),
                    immediate < static_cast<std::int32_t>(protocol::Hint::leave_phase), clock);
    return happen(immediate, clock);
  }
  // Not a command, but news: the next HINT ends no earlier.
  channel_.bound.store(clock + kCommandCycles, std::memory_order_release);
  if (clock + kCommandCycles > channel_.wanted.load(std::memory_order_relaxed)) wake_network(channel_);
  return {Outcome::done, clock};
}

NiuProcessorSide::Result NiuProcessorSide::happen(std::int32_t immediate, std::uint64_t clock) {
  using enum Outcome;
  const bool marker = protocol::is_phase_marker(immediate);
  auto& window = *reinterpret_cast<protocol::NiuWindow*>(local_memory_.data() + window_offset_);
  if (waiting_ == Waiting::returns) channel_.asleep.store(0, std::memory_order_relaxed);
  HintRun run(channel_, local_memory_, window_offset_, clock, waiting_);
  const bool happened = !marker && run.execute(static_cast<protocol::Hint>(immediate));
  if (run.waits()) {
    window.retry = 1;
    return {run.must_stop() ? stop : retry, clock};  // where the machine stops, it waits to the end
  }
  if (run.clock() != clock) {
    ProcessorState& state = channel_.processor;
    if (StateLog* const log = state_log_of(channel_)) log->waited(channel_, run.waited());
    state.busy.add_interval(state.busy_since, clock, 1);
    state.busy_since = run.clock();
    state.waited += run.clock() - clock;
    for (std::size_t i = 0; i < kWaitReasons; ++i) {
      channel_.waits[i].store(channel_.waits[i].load(std::memory_order_relaxed) + run.waited()[i],
                              std::memory_order_relaxed);
    }
  }
  channel_.clock.store(run.clock(), std::memory_order_relaxed);
  channel_.processor.last_hint = run.clock();
  if (run.stage() != channel_.processor.stage) begin_stage(channel_, run.stage());
  window.retry = 0;
  if (StateLog* const log = state_log_of(channel_)) log->hint_ended();
  // The next HINT ends at least one cycle later.
  const std::uint64_t next = std::max(run.clock() + kCommandCycles + 1, channel_.processor.last_command);
  publish_bound(channel_, channel_.takes_turns != 0 && happened ? run.clock() + kCommandCycles : next,
                pack_wait(happened ? WaitKind::running : WaitKind::halted, 0));
  return {happened ? done : stop, run.clock()};
}

}  // namespace torolux
