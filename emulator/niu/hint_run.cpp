// SPDX-License-Identifier: MIT
// A HINT: waiting, slots, sending. Receiving is in hint_receive.cpp.
#include "emulator/niu/hint_run.hpp"

#include <array>
#include <cstring>

#include "emulator/niu/ending.hpp"
#include "emulator/niu/slot_list.hpp"
#include "emulator/niu/state_log.hpp"

namespace torolux {

using protocol::Hint;
using protocol::kMostMessageBytes;
using protocol::kMostPacketBytes;
using protocol::kMostRecordsPerPacket;
using protocol::NiuWindow;

namespace {

/// The most that one HINT puts into the command ring.
constexpr std::size_t kLargestCommands = kMostMessageBytes + 4 * sizeof(Command);

/// As in Command::kinds; what is unknown is left to the network.
std::uint64_t told_kind(const RecordKinds& kinds, std::span<const std::byte> record) {
  const std::size_t kind = kinds.record_kind(record);
  return kind < kMostToldKinds ? kind + 1 : 0;
}

}  // namespace

void wake_network(NiuChannel& channel) {
  channel.wanted.store(kNever, std::memory_order_relaxed);
  channel.network_signal.fetch_add(1, std::memory_order_seq_cst);
  futex_wake(channel.network_signal);
}

void publish_bound(NiuChannel& channel, std::uint64_t bound, std::uint64_t wait) {
  channel.bound.store(bound, std::memory_order_release);
  channel.wait.store(wait, std::memory_order_seq_cst);
  const std::uint64_t wanted = channel.wanted.load(std::memory_order_seq_cst);
  const bool waits = wait_kind(wait) != WaitKind::running;
  if (wanted == kNever || (bound <= wanted && !waits)) return;
  wake_network(channel);
}

/// The clock moves to `time`, unless it is there already; what it waits counts for the reason.
void HintRun::wait_until(std::uint64_t time, WaitReason reason) {
  if (time <= clock_) return;
  waited_[static_cast<std::size_t>(reason)] += time - clock_;
  clock_ = time;
}

bool HintRun::has_room() const {
  const StateLog* const log = state_log_of(channel_);
  return channel_.commands.has_room(kLargestCommands) && (log == nullptr || log->has_room());
}

bool HintRun::wait_for_room() {
  return sleep_until(WaitKind::running, 0, [this] { return has_room(); });
}

bool HintRun::execute(Hint hint) {
  // Before it sleeps: nobody waits for it then.
  if (StateLog* const log = state_log_of(channel_)) log->busy_until(channel_, begin_);
  if (channel_.until != 0 && clock_ >= channel_.until) return sleep_until(WaitKind::until, 0, [] { return false; });
  if (!has_room() && !wait_for_room()) return false;
  if (clock_ - state_.last_hint > channel_.most_cycles_between_hints) {
    end_endless_loop(channel_, 0);
    end();
    return false;
  }
  switch (hint) {
    case Hint::send_records:
      send_records();
      break;
    case Hint::send_message:
      send_message();
      break;
    case Hint::receive:
      receive();
      break;
    case Hint::receive_if_any:
      poll(clock_);
      break;
    case Hint::receive_more:
      poll(state_.gather_end);
      break;
    case Hint::receive_due:
      poll(last_tick());
      break;
    case Hint::clock:
      window_.clock = clock_;
      break;
    case Hint::set_slots:
      set_slots();
      break;
    case Hint::halt:
      push(CommandKind::halt);
      end();
      break;
    case Hint::fail:
      push(CommandKind::fail, 0, std::as_bytes(std::span(&window_.fault, 1)));
      end();
      break;
    default:
      end_with_fault(NiuFaultCode::unknown_hint, static_cast<std::uint32_t>(hint));
      break;
  }
  return !later_ && !stop_;
}

// ---- Slots ----

bool HintRun::give_back(std::uint32_t slot) {
  const auto fault = release_slot(state_, slot);
  if (fault) end_with_fault(*fault);
  return !fault;
}

void HintRun::release_listed() {
  const std::uint32_t released = window_.released;
  if (released == 0) return;
  if (released > window_.release.size()) {
    end_with_fault(NiuFaultCode::too_many_released, released);
    return;
  }
  for (std::uint32_t i = 0; i < released; ++i) {
    if (!give_back(window_.release[i])) return;
  }
  window_.released = 0;
  push(CommandKind::release, released);
}

void HintRun::set_slots() {
  const NiuWindow::Slots& slots = window_.slots;
  const std::uint64_t all = std::uint64_t{slots.own} + slots.niu;
  const bool good = slots.niu <= kMostNiuSlots && all <= kNoSlot && slots.bytes % 8 == 0 && slots.bytes >= 8 &&
                    slots.bytes <= kMostPacketBytes && inside_memory(slots.address, all * slots.bytes);
  if (!good) return end_with_fault(NiuFaultCode::bad_slots, slots.address, slots.own, slots.niu);
  if (state_.slots_free != state_.niu_slots) {
    return end_with_fault(NiuFaultCode::slots_in_use, state_.niu_slots - state_.slots_free);
  }
  set_slot_list(state_, slots);
  const SlotsCommand command{slots.niu, slots.bytes};
  push(CommandKind::set_slots, 0, std::as_bytes(std::span(&command, 1)));
}

// ---- Sending ----

/// The outgoing engine begins to copy as soon as it is free; the processor waits for that, and no longer. When the copy
/// has ended.
std::uint64_t HintRun::copy_out(std::uint64_t bytes) {
  wait_until(state_.copy_free, WaitReason::copy);
  const std::uint64_t cycles = copy_cycles(bytes, channel_.copy_bytes);
  channel_.copied.store(channel_.copied.load(std::memory_order_relaxed) + cycles, std::memory_order_relaxed);
  state_.copy_free = clock_ + cycles;
  return state_.copy_free;
}

/// Packet number `sent` needs a place in a queue of so many: the clock moves to when it is free.
bool HintRun::wait_for_place(const Departures& departures, std::uint64_t sent, std::uint32_t places, WaitKind kind,
                             WaitReason reason) {
  if (sent < places) return true;
  const std::uint64_t needed = sent - places + 1;
  const auto ready = [&] { return departures.count.load(std::memory_order_seq_cst) >= needed; };
  if (!sleep_until(kind, needed, ready)) return false;
  wait_until(departures.when(needed - 1), reason);
  return true;
}

void HintRun::send_records() {
  const NiuWindow::Send& send = window_.send;
  const std::uint32_t count = send.count;
  const std::uint32_t bytes = count * state_.slot_bytes;
  if (count == 0 || count > kMostRecordsPerPacket || bytes == 0 || bytes > kMostPacketBytes) {
    return end_with_fault(NiuFaultCode::bad_count, count, state_.slot_bytes);
  }
  if (send.destination >= channel_.pes) return end_with_fault(NiuFaultCode::bad_destination, send.destination);
  release_listed();
  if (stop_ || !wait_for_place(channel_.torus_departures, state_.packets_sent, channel_.torus_queue,
                               WaitKind::torus_place, WaitReason::torus_place)) {
    return;
  }
  std::array<std::byte, kMostPacketBytes> ring;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
  Payload* const payload = take_payload();
  const std::span<std::byte> records = payload != nullptr ? std::span(payload->bytes) : std::span(ring);
  Command command{0, CommandKind::send_records, send.destination, 0, static_cast<std::uint16_t>(count), 0, 0, 0};
  if (!gather(records.first(bytes), command)) {
    if (payload != nullptr) channel_.payloads->give_back(payload);
    return;
  }
  ++state_.packets_sent;
  command.time = command_time(state_, copy_out(bytes));
  command.payload = payload;
  command.lent = static_cast<std::uint16_t>(payload != nullptr ? bytes : 0);
  push(command, payload != nullptr ? std::span<std::byte>() : records.first(bytes));
}

/// From the slots that are to be sent; what becomes free, and what kinds there are, is noted. False: a fault.
bool HintRun::gather(std::span<std::byte> records, Command& command) {
  for (std::uint32_t i = 0; i < command.records; ++i) {
    const std::uint32_t slot = window_.send.slots[i];
    if (slot >= state_.own_slots + state_.niu_slots) {
      end_with_fault(NiuFaultCode::bad_slot, slot, state_.own_slots, state_.niu_slots);
      return false;
    }
    const auto record = records.subspan(std::size_t{i} * state_.slot_bytes, state_.slot_bytes);
    std::memcpy(record.data(), slot_bytes(slot), state_.slot_bytes);
    if (channel_.record_kinds != nullptr) command.kinds |= told_kind(*channel_.record_kinds, record) << (4 * i);
    if (slot < state_.own_slots) continue;
    if (!give_back(slot)) return false;
    ++command.released;
  }
  return true;
}

void HintRun::send_message() {
  const NiuWindow::Send& send = window_.send;
  if (send.destination != protocol::kHost && send.destination != protocol::kFrameBuffer) {
    return end_with_fault(NiuFaultCode::bad_destination, send.destination);
  }
  protocol::MessageHeader header{};
  if (!inside_memory(send.address, sizeof header)) {
    return end_with_fault(NiuFaultCode::bad_address, send.address, sizeof header);
  }
  std::memcpy(&header, at(send.address), sizeof header);
  if (header.bytes > kMostMessageBytes) return end_with_fault(NiuFaultCode::bad_message_length, header.bytes);
  if (!inside_memory(send.address, sizeof header + header.bytes)) {
    return end_with_fault(NiuFaultCode::bad_address, send.address, header.bytes);
  }
  release_listed();
  if (stop_ || !wait_for_place(channel_.bus_departures, state_.messages_sent, channel_.bus_queue, WaitKind::bus_place,
                               WaitReason::bus_place)) {
    return;
  }
  ++state_.messages_sent;
  const std::span<const std::byte> contents(at(send.address) + sizeof header, header.bytes);
  Command command{command_time(state_, copy_out(sizeof header + header.bytes)),
                  CommandKind::send_message,
                  send.destination,
                  header.kind,
                  0,
                  0,
                  0,
                  0};
  command.payload = contents.empty() ? nullptr : take_payload();
  if (command.payload == nullptr) return push(command, contents);
  command.lent = static_cast<std::uint16_t>(contents.size());
  std::memcpy(command.payload->bytes.data(), contents.data(), contents.size());
  push(command, {});
}

}  // namespace torolux
