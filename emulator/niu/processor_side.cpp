// SPDX-License-Identifier: MIT
// The processor's side of a NIU: HINTs become commands to the network side, arrivals go into local memory. Where the
// answer is already known this takes no system call; otherwise the processor says what it waits for, and sleeps.
#include "emulator/niu/processor_side.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "emulator/niu/channel.hpp"
#include "emulator/niu/futex.hpp"
#include "emulator/niu/profile.hpp"
#include "emulator/niu/slot_list.hpp"
#include "firmware/protocol/niu_window.hpp"

namespace torolux {

namespace {

using protocol::Hint;
using protocol::kLocalMemoryBase;
using protocol::kMostMessageBytes;
using protocol::kMostPacketBytes;
using protocol::kMostRecordsPerPacket;
using protocol::NiuWindow;

/// One sleep of a processor; then the HINT is tried again, so that the engine can attend to other things.
constexpr std::chrono::microseconds kLongestSleep{50'000};
/// The most that one HINT puts into the command ring.
constexpr std::size_t kLargestCommands = kMostMessageBytes + 4 * sizeof(Command);

/// One HINT, from its arguments to its result.
class HintRun {
 public:
  HintRun(NiuChannel& channel, std::span<std::byte> memory, std::uint32_t window_offset, std::uint64_t clock,
          NiuProcessorSide::Waiting waiting)
      : channel_(channel),
        state_(channel.processor),
        memory_(memory),
        window_(*reinterpret_cast<NiuWindow*>(memory.data() + window_offset)),
        begin_(clock),
        clock_(clock),
        waiting_(waiting) {}

  /// False: not yet, or never (`stop`).
  bool execute(Hint hint);
  std::uint64_t clock() const { return clock_; }
  const WaitCycles& waited() const { return waited_; }  ///< clock() - the clock at the beginning, by reason
  std::uint32_t stage() const { return stage_; }        ///< of the last arrival taken
  bool must_stop() const { return stop_; }

 private:
  void send_records();
  void send_message();
  void receive();
  void poll(std::uint64_t by);
  void set_slots();
  void take(const Arrival& arrival);
  void take_records(const Arrival& arrival, std::span<const std::byte> records);
  void release_listed();

  bool wait_for_place(const Departures& departures, std::uint64_t sent, std::uint32_t places, WaitKind kind,
                      WaitReason reason);
  std::uint64_t copy_out(std::uint64_t bytes);
  bool wait_for_room();
  void wait_until(std::uint64_t time, WaitReason reason);
  bool wakes_now(const Arrival& head) const;
  void take_nothing();
  template <class Ready>
  bool sleep_until(WaitKind kind, std::uint64_t count, Ready ready);

  bool give_back(std::uint32_t slot);
  bool inside_memory(std::uint64_t address, std::uint64_t bytes) const {
    return address >= kLocalMemoryBase && address - kLocalMemoryBase + bytes <= memory_.size();
  }
  std::byte* at(std::uint64_t address) const { return memory_.data() + (address - kLocalMemoryBase); }
  std::byte* slot_bytes(std::uint32_t slot) const {
    return at(state_.slots_address + std::uint64_t{slot} * state_.slot_bytes);
  }

  void push(CommandKind kind, std::uint32_t released = 0, std::span<const std::byte> payload = {}) {
    push({command_time(state_, clock_), kind, 0, 0, 0, released, 0}, payload);
  }
  void push(const Command& command, std::span<const std::byte> payload) { channel_.commands.push(command, payload); }
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
  NiuWindow& window_;
  std::uint64_t begin_;
  std::uint64_t clock_;
  WaitCycles waited_{};
  NiuProcessorSide::Waiting waiting_;
  std::uint32_t stage_ = channel_.processor.stage;
  bool later_ = false;
  bool stop_ = false;
};

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

/// Says what the processor waits for, and sleeps a while (if it may) unless `ready` holds. True: ready.
template <class Ready>
bool HintRun::sleep_until(WaitKind kind, std::uint64_t count, Ready ready) {
  if (ready()) return true;
  channel_.clock.store(begin_, std::memory_order_relaxed);
  publish_bound(channel_, clock_ + kCommandCycles, pack_wait(kind, count));
  const bool sleeps = waiting_ == NiuProcessorSide::Waiting::sleeps;
  const auto deadline =
      sleeps ? std::chrono::steady_clock::now() + kLongestSleep : std::chrono::steady_clock::time_point();
  for (;;) {
    const std::uint32_t signal = channel_.processor_signal.load(std::memory_order_seq_cst);
    channel_.asleep.store(1, std::memory_order_seq_cst);
    const bool is_ready = ready();
    const bool stopping = channel_.stopping.load(std::memory_order_seq_cst) != 0;
    if (sleeps && !is_ready && !stopping && std::chrono::steady_clock::now() < deadline) {
      futex_wait(channel_.processor_signal, signal, kLongestSleep);
      continue;
    }
    // One that returns is asleep until it is woken, and calls again.
    if (sleeps || is_ready) channel_.asleep.store(0, std::memory_order_relaxed);
    if (stopping) end();
    if (!is_ready) later_ = true;
    return is_ready && !stopping;
  }
}

/// The clock moves to `time`, unless it is there already; what it waits counts for the reason.
void HintRun::wait_until(std::uint64_t time, WaitReason reason) {
  if (time <= clock_) return;
  waited_[static_cast<std::size_t>(reason)] += time - clock_;
  clock_ = time;
}

bool HintRun::wait_for_room() {
  return sleep_until(WaitKind::running, 0, [this] { return channel_.commands.has_room(kLargestCommands); });
}

bool HintRun::execute(Hint hint) {
  if (!channel_.commands.has_room(kLargestCommands) && !wait_for_room()) return false;
  if (clock_ - state_.last_hint > channel_.most_cycles_between_hints) {
    const std::uint64_t cycles = clock_ - state_.last_hint;
    end_with_fault(NiuFaultCode::too_long_without_hint, static_cast<std::uint32_t>(cycles),
                   static_cast<std::uint32_t>(cycles >> 32U),
                   static_cast<std::uint32_t>(channel_.most_cycles_between_hints));
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
  wait_until(departures.time[(needed - 1) % kMostSendQueue].load(std::memory_order_relaxed), reason);
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
  std::array<std::byte, kMostPacketBytes> records;  // NOLINT(cppcoreguidelines-pro-type-member-init): filled below
  std::uint32_t released = 0;
  for (std::uint32_t i = 0; i < count; ++i) {
    const std::uint32_t slot = send.slots[i];
    if (slot >= state_.own_slots + state_.niu_slots) {
      return end_with_fault(NiuFaultCode::bad_slot, slot, state_.own_slots, state_.niu_slots);
    }
    std::memcpy(&records[std::size_t{i} * state_.slot_bytes], slot_bytes(slot), state_.slot_bytes);
    if (slot < state_.own_slots) continue;
    if (!give_back(slot)) return;
    ++released;
  }
  ++state_.packets_sent;
  push({command_time(state_, copy_out(bytes)), CommandKind::send_records, send.destination, 0,
        static_cast<std::uint16_t>(count), released, 0},
       std::span(records).first(bytes));
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
  push({command_time(state_, copy_out(sizeof header + header.bytes)), CommandKind::send_message, send.destination,
        header.kind, 0, 0, 0},
       std::span<const std::byte>(at(send.address) + sizeof header, header.bytes));
}

// ---- Receiving ----

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
  const auto payload = channel_.arrivals.payload(arrival);
  if (window_.arrival.kind == protocol::ArrivalKind::records) {
    take_records(arrival, payload);
  } else {
    // From its control buffer into the window, while the processor waits for it.
    wait_until(clock_ + copy_cycles(sizeof window_.message + payload.size(), channel_.copy_bytes), WaitReason::copy);
    window_.message = {arrival.message_kind, arrival.source, arrival.bytes};
    if (!payload.empty()) std::memcpy(window_.message_bytes.data(), payload.data(), payload.size());
    push(CommandKind::received);
  }
  channel_.taken.store(channel_.taken.load(std::memory_order_relaxed) + 1, std::memory_order_relaxed);
  channel_.arrivals.pop(arrival);
}

void HintRun::take_records(const Arrival& arrival, std::span<const std::byte> records) {
  for (std::uint32_t i = 0; i < arrival.count; ++i) {
    const std::uint16_t slot = take_slot(state_);
    window_.arrival.slots[i] = slot;
    std::memcpy(slot_bytes(slot), records.data() + std::size_t{i} * state_.slot_bytes, state_.slot_bytes);
  }
}

}  // namespace

NiuProcessorSide::NiuProcessorSide(NiuChannel& channel, std::span<std::byte> local_memory, std::uint32_t window_offset,
                                   Waiting waiting)
    : channel_(channel), local_memory_(local_memory), window_offset_(window_offset), waiting_(waiting) {}

NiuProcessorSide::Result NiuProcessorSide::hint(std::int32_t immediate, std::uint64_t clock,
                                                std::uint64_t instructions) {
  using enum Outcome;
  if (wait_kind(channel_.wait.load(std::memory_order_relaxed)) == WaitKind::halted ||
      channel_.stopping.load(std::memory_order_relaxed) != 0) {
    return {stop, clock};
  }
  channel_.instructions.store(instructions, std::memory_order_relaxed);
  const bool marker = protocol::is_phase_marker(immediate);
  if (marker && mark_phase(channel_, immediate, clock)) {
    // Not a command, but news: the next HINT ends no earlier.
    channel_.bound.store(clock + kCommandCycles, std::memory_order_release);
    if (clock + kCommandCycles > channel_.wanted.load(std::memory_order_relaxed)) wake_network(channel_);
    return {done, clock};
  }

  auto& window = *reinterpret_cast<NiuWindow*>(local_memory_.data() + window_offset_);
  if (waiting_ == Waiting::returns) channel_.asleep.store(0, std::memory_order_relaxed);
  HintRun run(channel_, local_memory_, window_offset_, clock, waiting_);
  const bool happened = !marker && run.execute(static_cast<Hint>(immediate));
  if (!happened && !marker && !run.must_stop()) {
    window.retry = 1;
    return {retry, clock};
  }
  if (run.clock() != clock) {
    channel_.processor.busy.add_interval(channel_.processor.busy_since, clock, 1);
    channel_.processor.busy_since = run.clock();
  }
  for (std::size_t i = 0; i < kWaitReasons; ++i) {
    const std::uint64_t cycles = run.waited()[i];
    if (cycles == 0) continue;
    channel_.waits[i].store(channel_.waits[i].load(std::memory_order_relaxed) + cycles, std::memory_order_relaxed);
  }
  channel_.clock.store(run.clock(), std::memory_order_relaxed);
  channel_.processor.last_hint = run.clock();
  if (run.stage() != channel_.processor.stage) begin_stage(channel_, run.stage());
  window.retry = 0;
  // The next HINT ends at least one cycle later.
  publish_bound(channel_, std::max(run.clock() + kCommandCycles + 1, channel_.processor.last_command),
                pack_wait(happened ? WaitKind::running : WaitKind::halted, 0));
  return {happened ? done : stop, run.clock()};
}

}  // namespace torolux
