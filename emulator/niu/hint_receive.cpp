// SPDX-License-Identifier: MIT
// A HINT that receives: an arrival whose time has come goes from the channel into local memory.
#include <cstring>

#include "emulator/niu/hint_run.hpp"
#include "emulator/niu/pop_arrival.hpp"
#include "emulator/niu/slot_list.hpp"

namespace torolux {

/// Whether the first arrival alone decides when the processor is woken: then nobody need be asked.
bool HintRun::wakes_now(const Arrival& head) const {
  return static_cast<protocol::ArrivalKind>(head.kind) == protocol::ArrivalKind::message ||
         head.count >= window_.gather.records || gathering(head.time, window_.gather.cycles).wake <= clock_;
}

void HintRun::receive() {
  release_listed();
  if (stop_) return;
  const Arrival* head = channel_.arrivals.front();
  if (head != nullptr && (window_.gather.cycles == 0 || wakes_now(*head))) {
    wait_until(head->time, WaitReason::arrivals);
  } else {
    channel_.gather_cycles.store(window_.gather.cycles, std::memory_order_relaxed);
    channel_.gather_records.store(window_.gather.records, std::memory_order_relaxed);
    const std::uint64_t taken = channel_.taken.load(std::memory_order_relaxed);
    const auto is_due = [&] { return channel_.wakes.load(std::memory_order_seq_cst) > taken; };
    if (!sleep_until(WaitKind::receive, taken, is_due)) return;
    wait_until(channel_.wake_time.load(std::memory_order_relaxed), WaitReason::arrivals);
    head = channel_.arrivals.front();
  }
  state_.gather_end = gathering(head->time, window_.gather.cycles).last;
  state_.gathered = 0;
  take(*head);
}

/// A busy processor looks as far as the last tick would have let it see: what had come some time before that.
std::uint64_t HintRun::last_tick() const {
  const std::uint64_t cycles = window_.gather.cycles;
  if (cycles == 0) return clock_;
  const std::uint64_t tick = clock_ - clock_ % cycles;
  const std::uint64_t lead = cycles / 4;
  return tick > lead ? tick - lead : 0;
}

/// Takes the next of what has come by a time that is not after the clock, if there is one.
void HintRun::poll(std::uint64_t by) {
  release_listed();
  if (stop_) return;
  // The horizon is read before the ring: what came before it is then seen.
  const auto is_known = [&] {
    return channel_.horizon.load(std::memory_order_seq_cst) > by || !channel_.arrivals.empty();
  };
  if (!sleep_until(WaitKind::poll, by, is_known)) return;
  const Arrival* head = channel_.arrivals.front();
  if (head != nullptr && head->time <= by) {
    take(*head);
  } else {
    take_nothing();
  }
}

void HintRun::take_nothing() {
  window_.arrival.kind = protocol::ArrivalKind::none;
  window_.arrival.source = protocol::kNobody;
  window_.arrival.count = 0;
}

void HintRun::take(const Arrival& arrival) {
  state_.gathered += arrival.count;
  stage_ = arrival.stage;
  const bool ends = arrival.count == 0 || state_.gathered >= window_.gather.records;
  if (ends) state_.gather_end = 0;
  window_.arrival.kind = static_cast<protocol::ArrivalKind>(arrival.kind);
  window_.arrival.source = arrival.source;
  window_.arrival.count = arrival.count;
  const auto contents = contents_of(arrival);
  if (window_.arrival.kind == protocol::ArrivalKind::records) {
    take_records(arrival, contents);
  } else {
    // From its control buffer into the window, while the processor waits for it.
    wait_until(clock_ + copy_cycles(sizeof window_.message + contents.size(), channel_.copy_bytes), WaitReason::copy);
    window_.message = {arrival.message_kind, arrival.source, static_cast<std::uint32_t>(contents.size())};
    if (!contents.empty()) std::memcpy(window_.message_bytes.data(), contents.data(), contents.size());
    push(CommandKind::received);
  }
  channel_.taken.store(channel_.taken.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  pop_arrival(channel_, arrival);
}

void HintRun::take_records(const Arrival& arrival, std::span<const std::byte> records) {
  for (std::uint32_t i = 0; i < arrival.count; ++i) {
    const std::uint16_t slot = take_slot(state_);
    window_.arrival.slots[i] = slot;
    std::memcpy(slot_bytes(slot), records.data() + std::size_t{i} * state_.slot_bytes, state_.slot_bytes);
  }
}

}  // namespace torolux
