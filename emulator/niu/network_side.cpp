// SPDX-License-Identifier: MIT
// The network's side of a NIU: commands in, arrivals out, bounds.
#include "emulator/niu/network_side.hpp"

#include <algorithm>
#include <chrono>
#include <string>

#include "emulator/errors.hpp"
#include "emulator/niu/futex.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

namespace {
constexpr std::chrono::microseconds kLongestSleep{20'000};
}

NiuNetworkSide::NiuNetworkSide(NiuChannel& channel, unsigned pe, unsigned pes, const MachineDescription& machine)
    : channel_(&channel), pe_(pe), control_buffers_(machine.bus.control_buffers) {
  channel.torus_queue = machine.torus.send_queue_packets;
  channel.bus_queue = machine.bus.send_queue_messages;
  channel.pes = pes;
  channel.most_cycles_between_hints = machine.processor.most_cycles_between_hints;
  channel.processor.first_free = kNoSlot;
  channel.bound.store(kCommandCycles);
  channel.wanted.store(kNever);
}

bool NiuNetworkSide::refresh(EventQueue& events, BlockPool& pool, BoundTree& bounds) {
  // In this order: a wait that is seen belongs to a bound that is seen, and both to commands that are seen.
  wait_ = channel_->wait.load(std::memory_order_seq_cst);
  floor_ = std::max(floor_, channel_->bound.load(std::memory_order_acquire));
  drain(events, pool);
  refill(pool);
  const WaitKind waits = waits_for();
  const Cycles bound = waits == WaitKind::running || waits == WaitKind::receive_if_any ? floor_ : kNever;
  if (bound == bounds.at(pe_)) return false;
  bounds.set(pe_, bound);
  return true;
}

WaitKind NiuNetworkSide::waits_for() const {
  const WaitKind kind = wait_kind(wait_);
  const std::uint64_t count = wait_count(wait_);
  bool waits = true;
  switch (kind) {
    case WaitKind::receive:
    case WaitKind::receive_if_any:
      waits = count == delivered_;
      break;
    case WaitKind::torus_place:
      waits = channel_->torus_departures.count.load(std::memory_order_relaxed) < count;
      break;
    case WaitKind::bus_place:
      waits = channel_->bus_departures.count.load(std::memory_order_relaxed) < count;
      break;
    default:
      break;
  }
  return waits ? kind : WaitKind::running;
}

bool NiuNetworkSide::publish_horizon(Cycles horizon) {
  if (channel_->horizon.load(std::memory_order_relaxed) >= horizon) return false;
  channel_->horizon.store(horizon, std::memory_order_seq_cst);
  wake_processor();
  return true;
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
  channel_->processor_signal.fetch_add(1, std::memory_order_seq_cst);
  futex_wake(channel_->processor_signal);
}

void NiuNetworkSide::wake_processor() {
  if (channel_->asleep.load(std::memory_order_seq_cst) == 0) return;
  channel_->asleep.store(0, std::memory_order_relaxed);
  channel_->processor_signal.fetch_add(1, std::memory_order_seq_cst);
  futex_wake(channel_->processor_signal);
}

// ---- Commands ----

void NiuNetworkSide::drain(EventQueue& events, BlockPool& pool) {
  auto& ring = channel_->commands;
  bool any = false;
  while (const Command* command = ring.front()) {
    any = true;
    PendingCommand pending{command->kind, command->released, kNoBlock};
    const auto payload = ring.payload(*command);
    const bool sends = command->kind == CommandKind::send_records || command->kind == CommandKind::send_message;
    if (sends || !payload.empty()) {
      pending.block = pool.take();
      Block& block = pool[pending.block];
      block.number = (std::uint64_t{pe_} << 32U) | sends_++;
      block.source = static_cast<std::uint16_t>(pe_);
      block.destination = command->destination;
      block.message_kind = command->message_kind;
      block.records = command->records;
      block.set_payload(payload);
    }
    events.push(command->time, pe_, EventKind::command, static_cast<std::uint16_t>(pe_), 0, 0);
    commands_.push_back(pending);
    ring.pop(*command);
  }
  // A processor that waits for room in the ring says that it runs.
  if (any && wait_kind(wait_) == WaitKind::running) wake_processor();
}

PendingCommand NiuNetworkSide::next_command() {
  const PendingCommand command = commands_.front();
  commands_.pop_front();
  return command;
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

// ---- Towards the processor ----

void NiuNetworkSide::deliver(BlockIndex index, Cycles now, BlockPool& pool, BoundTree& bounds) {
  const bool waited = waits_for() == WaitKind::receive;
  ++delivered_;
  const Block& block = pool[index];
  if (overflow_.empty() && channel_->arrivals.has_room(block.bytes)) {
    push_arrival(block, now);
    pool.give_back(index);
  } else {
    overflow_.push_back({now, index});
  }
  if (waited) may_go_on(now, bounds);
  const WaitKind kind = waits_for();
  if (kind != WaitKind::torus_place && kind != WaitKind::bus_place) wake_processor();
}

void NiuNetworkSide::push_arrival(const Block& block, Cycles time) {
  const auto kind = block.records != 0 ? protocol::ArrivalKind::records : protocol::ArrivalKind::message;
  channel_->arrivals.push(
      {time, static_cast<std::uint16_t>(kind), block.source, block.records, block.message_kind, 0, 0}, block.payload());
}

void NiuNetworkSide::refill(BlockPool& pool) {
  bool any = false;
  while (!overflow_.empty() && channel_->arrivals.has_room(pool[overflow_.front().block].bytes)) {
    push_arrival(pool[overflow_.front().block], overflow_.front().time);
    pool.give_back(overflow_.front().block);
    overflow_.pop_front();
    any = true;
  }
  if (any) wake_processor();
}

void NiuNetworkSide::left(Departures& departures, Cycles now, BoundTree& bounds) {
  const bool waited = waits_for() == WaitKind::torus_place || waits_for() == WaitKind::bus_place;
  departures.add(now);
  const WaitKind waits = waits_for();
  if (waited && waits == WaitKind::running) may_go_on(now, bounds);
  if (waits != WaitKind::receive && waits != WaitKind::receive_if_any) wake_processor();
}

/// A processor that waited has got what it waited for at `now`: its next command comes later.
void NiuNetworkSide::may_go_on(Cycles now, BoundTree& bounds) {
  floor_ = std::max(floor_, now + kCommandCycles);
  bounds.set(pe_, floor_);
}

}  // namespace torolux
