// SPDX-License-Identifier: MIT
// One HINT while it happens: its operation and clock enter; commands, arrivals in local memory, waits and a later clock
// leave. For the processor's side of a NIU alone.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <span>

#include "emulator/niu/channel.hpp"
#include "emulator/niu/futex.hpp"
#include "emulator/niu/processor_side.hpp"
#include "emulator/niu/profile.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

/// Wakes the scheduler, where it sleeps for this PE.
void wake_network(NiuChannel& channel);
/// No command with an earlier time than `bound` will come; wait: what the processor waits for (pack_wait).
void publish_bound(NiuChannel& channel, std::uint64_t bound, std::uint64_t wait);

/// One sleep of a processor; then the HINT is tried again, so that the engine can attend to other things.
inline constexpr std::chrono::microseconds kLongestProcessorSleep{50'000};
/// One HINT, from its arguments to its result.
class HintRun {
 public:
  HintRun(NiuChannel& channel, std::span<std::byte> memory, std::uint32_t window_offset, std::uint64_t clock,
          NiuProcessorSide::Waiting waiting)
      : channel_(channel),
        state_(channel.processor),
        memory_(memory),
        window_(*reinterpret_cast<protocol::NiuWindow*>(memory.data() + window_offset)),
        begin_(clock),
        clock_(clock),
        waiting_(waiting) {}

  /// False: not yet, or never (`stop`).
  bool execute(protocol::Hint hint);
  std::uint64_t clock() const { return clock_; }
  const WaitCycles& waited() const { return waited_; }  ///< clock() - the clock at the beginning, by reason
  std::uint32_t stage() const { return stage_; }        ///< of the last arrival taken
  bool must_stop() const { return stop_; }
  bool waits() const { return later_; }  ///< what it waits for has not come yet

 private:
  void send_records();
  bool gather(std::span<std::byte> records, Command& command);
  void send_message();
  void receive();
  void poll(std::uint64_t by);
  std::uint64_t last_tick() const;
  void set_slots();
  void take(const Arrival& arrival);
  void take_records(const Arrival& arrival, std::span<const std::byte> records);
  void release_listed();

  bool wait_for_place(const Departures& departures, std::uint64_t sent, std::uint32_t places, WaitKind kind,
                      WaitReason reason);
  std::uint64_t copy_out(std::uint64_t bytes);
  bool has_room() const;
  bool wait_for_room();
  void wait_until(std::uint64_t time, WaitReason reason);
  bool wakes_now(const Arrival& head) const;
  void take_nothing();
  template <class Ready>
  bool sleep_until(WaitKind kind, std::uint64_t count, Ready ready);

  bool give_back(std::uint32_t slot);
  bool inside_memory(std::uint64_t address, std::uint64_t bytes) const {
    return address >= protocol::kLocalMemoryBase && address - protocol::kLocalMemoryBase + bytes <= memory_.size();
  }
  std::byte* at(std::uint64_t address) const { return memory_.data() + (address - protocol::kLocalMemoryBase); }
  std::byte* slot_bytes(std::uint32_t slot) const {
    return at(state_.slots_address + std::uint64_t{slot} * state_.slot_bytes);
  }

  void push(CommandKind kind, std::uint32_t released = 0, std::span<const std::byte> contents = {}) {
    push({command_time(state_, clock_), kind, 0, 0, 0, static_cast<std::uint16_t>(released), 0, 0}, contents);
  }
  /// contents: follow in the ring.
  void push(const Command& command, std::span<const std::byte> contents) { channel_.commands.push(command, contents); }
  /// A place for contents, which then need not go through the ring; nullptr: there is none.
  Payload* take_payload() { return channel_.payloads != nullptr ? channel_.payloads->take() : nullptr; }
  void end_with_fault(NiuFaultCode code, std::uint32_t a = 0, std::uint32_t b = 0, std::uint32_t c = 0) {
    end_with_fault({code, {a, b, c}});
  }
  void end_with_fault(const NiuFault& fault) {
    push(CommandKind::fault, 0, std::as_bytes(std::span(&fault, 1)));
    end();
  }
  /// This processor executes nothing more.
  void end() { stop_ = true; }

  NiuChannel& channel_;
  ProcessorState& state_;
  std::span<std::byte> memory_;
  protocol::NiuWindow& window_;
  std::uint64_t begin_;
  std::uint64_t clock_;
  WaitCycles waited_{};
  NiuProcessorSide::Waiting waiting_;
  std::uint32_t stage_ = channel_.processor.stage;
  bool later_ = false;
  bool stop_ = false;
};

/// Says what the processor waits for, and sleeps a while (if it may) unless `ready` holds. True: ready.
template <class Ready>
bool HintRun::sleep_until(WaitKind kind, std::uint64_t count, Ready ready) {
  if (ready()) return true;
  window_.retry = 1;  // whether it returns before it happens or not: what can be seen does not depend on that
  channel_.clock.store(begin_, std::memory_order_relaxed);
  publish_bound(channel_, clock_ + kCommandCycles, pack_wait(kind, count));
  const bool sleeps = waiting_ == NiuProcessorSide::Waiting::sleeps;
  const auto deadline =
      sleeps ? std::chrono::steady_clock::now() + kLongestProcessorSleep : std::chrono::steady_clock::time_point();
  for (;;) {
    const std::uint32_t signal = channel_.processor_signal.load(std::memory_order_seq_cst);
    channel_.asleep.store(1, std::memory_order_seq_cst);
    const bool is_ready = ready();
    const bool stopping = channel_.stopping.load(std::memory_order_seq_cst) != 0;
    if (sleeps && !is_ready && !stopping && std::chrono::steady_clock::now() < deadline) {
      futex_wait(channel_.processor_signal, signal, kLongestProcessorSleep);
      continue;
    }
    // One that returns is asleep until it is woken, and calls again.
    if (sleeps || is_ready) channel_.asleep.store(0, std::memory_order_relaxed);
    if (stopping) end();
    if (!is_ready) later_ = true;
    return is_ready && !stopping;
  }
}

}  // namespace torolux
