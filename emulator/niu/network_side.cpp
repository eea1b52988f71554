// SPDX-License-Identifier: MIT
// The network's side of a NIU: commands in, arrivals out, bounds.
#include "emulator/niu/network_side.hpp"

#include <algorithm>
#include <chrono>
#include <limits>
#include <string>
#include <utility>

#include "emulator/errors.hpp"
#include "emulator/niu/futex.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

namespace {
constexpr std::chrono::microseconds kLongestSleep{20'000};
}

NiuNetworkSide::NiuNetworkSide(NiuChannel& channel, unsigned pe, unsigned pes, const MachineDescription& machine,
                               ProcessorWaker* waker)
    : receive_buffers_(machine.ideal.niu ? std::numeric_limits<std::uint32_t>::max() : machine.niu.receive_packets),
      copy_bytes_(machine.copy_bytes()),
      channel_(&channel),
      waker_(waker),
      pe_(pe),
      torus_places_(machine.torus.send_queue_packets),
      control_buffers_(machine.bus.control_buffers),
      far_(waker != nullptr && waker->is_far()) {
  set_up_channel(channel, pes, machine, waker != nullptr);
}

void set_up_channel(NiuChannel& channel, unsigned pes, const MachineDescription& machine, bool on_thread) {
  channel.torus_queue = machine.torus.send_queue_packets;
  channel.bus_queue = machine.bus.send_queue_messages;
  channel.torus_departures.set_places(channel.torus_queue);
  channel.bus_departures.set_places(channel.bus_queue);
  channel.pes = pes;
  channel.copy_bytes = machine.copy_bytes();
  channel.most_cycles_between_hints = machine.processor.most_cycles_between_hints;
  const std::uint32_t ring_bytes = on_thread || pes > kManyPes ? kLeastRingBytes : kMostRingBytes;
  channel.set_ring_bytes(channel.ring_bytes != 0 ? std::min(channel.ring_bytes, ring_bytes) : ring_bytes);
  channel.processor.first_free = kNoSlot;
  channel.bound.store(kCommandCycles);
  channel.wanted.store(kNever);
}

bool NiuNetworkSide::take_in(EventQueue& events, BlockPool& pool, PeTimes& times) {
  channel_->commands.fetch_ahead();
  // In this order: a wait that is seen belongs to a bound that is seen, and both to commands that are seen.
  wait_ = channel_->wait.load(std::memory_order_seq_cst);
  bound_ = channel_->bound.load(std::memory_order_acquire);
  floor_ = std::max(floor_, bound_);
  drain(events, pool);
  refill(pool);
  // A processor that receives may go on by itself, where the first arrival alone decides; until it has said so, what it
  // waits for is still the wake-up for that one.
  const bool receives = wait_kind(wait_) == WaitKind::receive;
  const std::uint64_t taken = receives ? wait_count(wait_) : channel_->taken.load(std::memory_order_relaxed);
  for (; taken_ < taken; ++taken_) gathered_.pop_front();
  return set_times(times);
}

bool NiuNetworkSide::waits(WaitKind kind, std::uint64_t count) const {
  switch (kind) {
    case WaitKind::receive:
      return wakes_ <= count;
    case WaitKind::poll:
      return horizon_ <= count && gathered_.empty();
    case WaitKind::torus_place:
      return departed_torus_ < count;
    case WaitKind::bus_place:
      return departed_bus_ < count;
    default:
      return true;
  }
}

/// The next wake-up of a processor that receives, if nothing more comes before its end; kNever: nothing is there.
Gathering NiuNetworkSide::next_wake() const {
  if (gathered_.empty()) return {kNever, kNever};
  Gathering next = gathering(gathered_.front().time, channel_->gather_cycles.load(std::memory_order_relaxed));
  const std::uint32_t enough = channel_->gather_records.load(std::memory_order_relaxed);
  std::uint32_t records = 0;
  for (const Gathered& arrival : gathered_.inside()) {
    if (arrival.time > next.last) break;
    records += arrival.records;
    if (arrival.records == 0 || records >= enough) next = {arrival.time, 0};
  }
  return {std::max(bound_ - kCommandCycles, next.wake), next.last};
}

/// True: something has changed.
bool NiuNetworkSide::set_times(PeTimes& times) const {
  Cycles bound = floor_;
  Cycles release = kNever;
  switch (waits_for()) {
    case WaitKind::running:
      break;
    case WaitKind::receive:
      bound = release = kNever;
      if (const Gathering next = next_wake(); next.wake != kNever) {
        bound = next.wake + kCommandCycles;
        release = next.last + 1;
      }
      break;
    case WaitKind::poll:
      if (tells_polls_) release = wait_count(wait_) + 1;
      break;
    default:
      bound = kNever;
      break;
  }
  const bool new_bound = times.bounds.at(pe_) != bound;
  const bool new_release = times.releases.at(pe_) != release;
  if (new_bound) times.bounds.set(pe_, bound);
  if (new_release) times.releases.set(pe_, release);
  return new_bound || new_release;
}

void NiuNetworkSide::release(Cycles horizon, PeTimes& times) {
  publish_horizon(horizon);
  if (waits_for() == WaitKind::receive) {
    const Cycles wake = next_wake().wake;
    floor_ = std::max(floor_, wake + kCommandCycles);
    wakes_ = wait_count(wait_) + 1;
    channel_->wake_time.store(wake, std::memory_order_relaxed);
    channel_->wakes.store(wakes_, std::memory_order_seq_cst);
  }
  wake_processor();
  set_times(times);
}

/// What the processor says right now, whatever it said at the last refresh.
WaitKind NiuNetworkSide::says() const {
  return wait_kind(channel_->wait.load(std::memory_order_seq_cst));
}

void NiuNetworkSide::publish_horizon(Cycles horizon) {
  // What waits for room in the ring is not known to the processor.
  if (!overflow_.empty()) horizon = std::min(horizon, overflow_.front().time);
  if (horizon_ >= horizon) return;
  horizon_ = horizon;
  channel_->horizon.store(horizon, std::memory_order_release);
  if (says() == WaitKind::poll) wake_processor();  // it may just have begun to
}

void NiuNetworkSide::sleep_until_bound(Cycles wanted) {
  const std::uint32_t signal = channel_->network_signal.load(std::memory_order_seq_cst);
  channel_->wanted.store(std::min(wanted, kNever - 1), std::memory_order_seq_cst);
  const bool stands = channel_->wait.load(std::memory_order_seq_cst) == wait_ &&
                      channel_->bound.load(std::memory_order_seq_cst) <= floor_;
  if (stands) futex_wait(channel_->network_signal, signal, kLongestSleep);
  channel_->wanted.store(kNever, std::memory_order_relaxed);
}

void NiuNetworkSide::tell_to_stop() {
  channel_->stopping.store(1, std::memory_order_seq_cst);
  signal_processor();
}

void NiuNetworkSide::wake_processor() {
  if (channel_->asleep.load(std::memory_order_seq_cst) == 0) return;
  channel_->asleep.store(0, std::memory_order_relaxed);
  signal_processor();
}

void NiuNetworkSide::wake_if_overlooked() {
  if (waits_for() == WaitKind::running) wake_processor();
}

void NiuNetworkSide::signal_processor() {
  if (waker_ != nullptr) return waker_->wake(pe_);
  channel_->processor_signal.fetch_add(1, std::memory_order_seq_cst);
  futex_wake(channel_->processor_signal);
}

// ---- Saving ----

void NiuNetworkSide::save_channel(SnapshotWriter& archive) const {
  archive_channel_state(archive, *channel_, channel_->horizon);
  archive_arrivals(archive, *channel_);
}

/// What has no room in the ring comes before what had none when it was saved.
void NiuNetworkSide::restore(SnapshotReader& archive, BlockPool& pool) {
  archive_own(archive);
  archive_channel_state(archive, *channel_, channel_->horizon);
  Fifo<Overflow> late;
  archive_arrivals(archive, *channel_, [&](const Arrival& arrival, std::span<const std::byte> contents) {
    const BlockIndex index = pool.take();
    Block& block = pool[index];
    block.source = arrival.source;
    block.records = arrival.count;
    block.message_kind = arrival.message_kind;
    pool.set_payload(index, contents);
    late.push_back({arrival.time, index, arrival.stage});
  });
  if (late.empty()) return;
  for (const Overflow& saved : overflow_.inside()) late.push_back(saved);
  overflow_ = std::move(late);
  horizon_ = std::min(horizon_, overflow_.front().time);
  channel_->horizon.store(horizon_, std::memory_order_relaxed);
}

// ---- Commands ----

void NiuNetworkSide::drain(EventQueue& events, BlockPool& pool) {
  auto& ring = channel_->commands;
  bool any = states_ != nullptr && drain_states();
  while (const Command* command = ring.front()) {
    any = true;
    BlockIndex index = kNoBlock;
    const auto contents = contents_of(*command);
    const bool sends = command->kind == CommandKind::send_records || command->kind == CommandKind::send_message;
    if (sends || !contents.empty()) {
      index = pool.take();
      Block& block = pool[index];
      block.number = (std::uint64_t{pe_} << 32U) | sends_++;
      block.source = static_cast<std::uint16_t>(pe_);
      block.destination = command->destination;
      block.message_kind = command->message_kind;
      block.records = command->records;
      block.released = command->released;
      block.kinds = command->kinds;
      if (command->payload != nullptr) {
        block.contents = command->payload;
        block.bytes = command->lent;
      } else {
        pool.set_payload(index, contents);
      }
    }
    if (command->kind == CommandKind::release) index = command->released;
    events.push(command->time, pe_, EventKind::command, static_cast<std::uint16_t>(pe_),
                static_cast<std::uint8_t>(command->kind), index);
    ring.pop(*command);
  }
  // A processor that waits for room in the ring says that it runs.
  if (any && wait_kind(wait_) == WaitKind::running) wake_processor();
}

bool NiuNetworkSide::drain_states() {
  return state_log_of(*channel_)->drain([this](const StateChange& change) { states_->push_back(change); });
}

void NiuNetworkSide::finish_states(Cycles end) {
  StateLog& log = *state_log_of(*channel_);
  drain_states();
  log.finish(*channel_, end, waits_for() == WaitKind::halted ? kHalted : kIdleAtEnd);
  drain_states();
}

// ---- Slots ----

void NiuNetworkSide::reserve_slots(std::uint32_t records) {
  used_ += records;
  high_water_ = std::max(high_water_, used_);
}

void NiuNetworkSide::release_slots(std::uint32_t records) {
  if (records > used_) {
    throw MachineFailure("PE " + std::to_string(pe_) + ": " + std::to_string(records) + " record slots released, " +
                         std::to_string(used_) + " in use");
  }
  used_ -= records;
}

// ---- Receive buffers ----

void NiuNetworkSide::reserve_receive_buffer() {
  ++receiving_;
  receiving_high_water_ = std::max(receiving_high_water_, receiving_);
}

Cycles NiuNetworkSide::copy_in(std::uint32_t bytes, Cycles now) {
  const Cycles cycles = copy_cycles(bytes, copy_bytes_);
  copy_free_ = std::max(copy_free_, now) + cycles;
  copy_in_cycles_ += cycles;
  return copy_free_;
}

std::optional<HostQueue> NiuNetworkSide::grant_slots() {
  if (bus_buffer_used_) return std::nullopt;
  for (const HostQueue queue : {HostQueue::resend, HostQueue::program}) {
    std::uint32_t& records = asked_[static_cast<std::size_t>(queue)];
    if (records == 0 || !has_slots(records)) continue;
    reserve_slots(records);
    records = 0;
    bus_buffer_used_ = copy_bytes_ != 0;
    return queue;
  }
  return std::nullopt;
}

// ---- Towards the processor ----

void NiuNetworkSide::deliver(BlockIndex index, Cycles now, BlockPool& pool, PeTimes& times) {
  Block& block = pool[index];
  gather(block, now);
  if (goes_into_ring(block)) {
    push_arrival(block, now, stage_);
    pool.give_back(index);
  } else {
    overflow_.push_back({now, index, stage_});
  }
  arrived(times);
}

void NiuNetworkSide::deliver_copy(const Block& message, Cycles now, BlockPool& pool, PeTimes& times) {
  gather(message, now);
  if (goes_into_ring(message)) {
    Arrival arrival = arrival_of(message, now, stage_);
    arrival.shared = arrival.payload != nullptr;
    if (arrival.shared) arrival.payload->holders.fetch_add(1, std::memory_order_relaxed);
    push(arrival, message);
  } else {
    const BlockIndex copy = pool.take();
    pool[copy].message_kind = message.message_kind;
    pool[copy].source = message.source;
    pool.set_payload(copy, message.payload());
    overflow_.push_back({now, copy, stage_});
  }
  arrived(times);
}

/// What has come is for the processor, once that is woken.
void NiuNetworkSide::gather(const Block& block, Cycles now) {
  if (block.records == 0 && ++control_used_ > control_buffers_) {
    throw MachineFailure("PE " + std::to_string(pe_) + ": its NIU has " + std::to_string(control_buffers_) +
                         " control buffers, and got message " + std::to_string(control_used_));
  }
  gathered_.push_back({now, block.records});
}

void NiuNetworkSide::arrived(PeTimes& times) {
  set_times(times);
  if (says() == WaitKind::poll) wake_processor();
}

Arrival NiuNetworkSide::arrival_of(const Block& block, Cycles time, std::uint8_t stage) const {
  const auto kind = block.records != 0 ? protocol::ArrivalKind::records : protocol::ArrivalKind::message;
  Arrival arrival{time, static_cast<std::uint16_t>(kind), block.source, block.records, block.message_kind, 0, stage};
  if (lends(block)) {
    arrival.payload = block.contents;
    arrival.lent = static_cast<std::uint16_t>(block.bytes);
  }
  return arrival;
}

void NiuNetworkSide::push(const Arrival& arrival, const Block& block) {
  channel_->arrivals.push(arrival, arrival.payload != nullptr ? std::span<const std::byte>() : block.payload());
  if (far_) waker_->told(pe_);
}

/// The payload of a processor that is near becomes its own: it is not even looked at here.
void NiuNetworkSide::push_arrival(Block& block, Cycles time, std::uint8_t stage) {
  const Arrival arrival = arrival_of(block, time, stage);
  if (arrival.payload != nullptr) block.contents = nullptr;
  push(arrival, block);
}

void NiuNetworkSide::refill(BlockPool& pool) {
  bool any = false;
  while (!overflow_.empty() && has_room_for(pool[overflow_.front().block])) {
    push_arrival(pool[overflow_.front().block], overflow_.front().time, overflow_.front().stage);
    pool.give_back(overflow_.front().block);
    overflow_.pop_front();
    any = true;
  }
  if (any) wake_processor();
}

void NiuNetworkSide::left(Departures& departures, std::uint64_t& departed, Cycles when, PeTimes& times) {
  const bool waited = waits_for() != WaitKind::running;
  departures.add(departed++, when);
  if (far_) waker_->told(pe_);
  if (waited && waits_for() == WaitKind::running) {
    floor_ = std::max(floor_, when + kCommandCycles);  // it goes on no earlier
    set_times(times);
  }
  const WaitKind waits = says();
  if (waits == WaitKind::torus_place || waits == WaitKind::bus_place) wake_processor();
}

}  // namespace torolux
