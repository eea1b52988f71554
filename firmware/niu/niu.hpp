// SPDX-License-Identifier: MIT
// NIU driver, thin: each operation of the NIU is one function that fills in the window and executes the HINT.
// The policy (batches, credits, when to sleep) is above it, in firmware/pe.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

#include "firmware/niu/memory.hpp"
#include "firmware/protocol/hints.hpp"
#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/niu_window.hpp"
#include "platform/hint_gate.hpp"

namespace torolux::pe {

using protocol::FaultCode;
using protocol::Hint;
using protocol::NiuWindow;
using protocol::PeNumber;
using protocol::Phase;
using Slot = std::uint16_t;  ///< number of a record slot

/// Room for one outgoing message, of any kind.
struct MessageBuffer {
  protocol::MessageHeader header;
  alignas(8) std::array<std::byte, protocol::kMostMessageBytes> bytes;

  template <class T>
  T* as() {
    static_assert(sizeof(T) <= protocol::kMostMessageBytes && alignof(T) <= 8);
    return reinterpret_cast<T*>(bytes.data());
  }
};
static_assert(offsetof(MessageBuffer, bytes) == sizeof(protocol::MessageHeader));

/// The whole page at `__niu_window`: the window that the emulator knows, and the driver's own message buffers.
struct NiuPage {
  NiuWindow window;
  alignas(8) MessageBuffer outgoing;  ///< Niu::send puts a message together here
  alignas(8) MessageBuffer batch;     ///< the program's, for a message that grows (pixels)
};
static_assert(sizeof(NiuPage) <= protocol::kPageBytes);

/// The NIU of this PE: each operation is one function. A value that may be copied; all copies are the same NIU.
class Niu {
 public:
  /// page: at `__niu_window` in `memory`. It outlives this.
  Niu(NiuPage& page, Memory memory, HintGate gate) : page_(&page), memory_(memory), gate_(gate) {}

  /// What processor and NIU share: own place in the torus, the last arrival, arguments of HINTs.
  NiuWindow& window() const { return page_->window; }
  /// The PE's local memory.
  const Memory& memory() const { return memory_; }
  /// A buffer that the program may fill piece by piece and give to send_message; the driver leaves it alone.
  MessageBuffer& batch() const { return page_->batch; }

  /// Own number, and the number of PEs of the torus.
  PeNumber pe() const { return static_cast<PeNumber>(window().pe); }
  std::uint32_t pes() const { return window().columns * window().rows; }
  /// First address after local memory.
  std::uint32_t memory_end() const { return protocol::kLocalMemoryBase + window().local_memory_bytes; }

  /// Sends the records in `slots` (1..kMostRecordsPerPacket) to another PE. They are copied: the program's own slots
  /// are free again afterwards, the NIU's go back to the NIU. Waits while the outgoing queue is full.
  void send_records(PeNumber destination, std::span<const Slot> slots) {
    NiuWindow::Send& send = window().send;
    send.destination = destination;
    send.count = static_cast<std::uint16_t>(slots.size());
    std::copy(slots.begin(), slots.end(), send.slots.begin());
    execute<Hint::send_records>();
  }

  /// The same: the record in `head`, and those in `more` slots that follow each other from `first` on.
  void send_records(PeNumber destination, Slot head, Slot first, std::uint32_t more) {
    NiuWindow::Send& send = window().send;
    send.destination = destination;
    send.count = static_cast<std::uint16_t>(more + 1);
    send.slots[0] = head;
    for (std::uint32_t i = 0; i < more; ++i) send.slots[i + 1] = static_cast<Slot>(first + i);
    execute<Hint::send_records>();
  }

  /// Sends a message (kind and bytes set in its header, contents right after it, in local memory, aligned to 8)
  /// to kHost or kFrameBuffer. It is copied. Waits while the outgoing queue is full.
  void send_message(PeNumber destination, const protocol::MessageHeader& header) {
    NiuWindow::Send& send = window().send;
    send.destination = destination;
    send.address = memory_.address_of(&header);
    execute<Hint::send_message>();
  }
  void send_message(PeNumber destination, std::uint16_t kind, std::span<const std::byte> contents) {
    MessageBuffer& out = page_->outgoing;
    out.header.kind = kind;
    out.header.bytes = static_cast<std::uint32_t>(contents.size());
    if (!contents.empty()) std::memcpy(out.bytes.data(), contents.data(), contents.size());
    send_message(destination, out.header);
  }
  /// To the host, nothing follows.
  void send(protocol::MessageKind kind) {
    send_message(protocol::kHost, static_cast<std::uint16_t>(kind), std::span<const std::byte>{});
  }
  /// To the host, one struct of the protocol.
  template <class T>
  void send(protocol::MessageKind kind, const T& contents) {
    static_assert(std::is_trivially_copyable_v<T> && sizeof(T) <= protocol::kMostMessageBytes);
    send_message(protocol::kHost, static_cast<std::uint16_t>(kind), std::as_bytes(std::span(&contents, 1)));
  }

  /// Sleeps until something has come, and records have gathered as `gather` says. The record slots that the arrival
  /// names are the program's until sent or released.
  const NiuWindow::Arrival& receive() {
    execute<Hint::receive>();
    return window().arrival;
  }
  /// What has come by now; kind `none` if nothing.
  const NiuWindow::Arrival& receive_if_any() {
    execute<Hint::receive_if_any>();
    return window().arrival;
  }
  /// The rest of what had come when `receive` ended; kind `none` if there is nothing left of it.
  const NiuWindow::Arrival& receive_more() {
    execute<Hint::receive_more>();
    return window().arrival;
  }
  /// What the NIU would have woken a sleeping processor for by its last tick; kind `none` if nothing. For a processor
  /// that is busy, and looks now and then.
  const NiuWindow::Arrival& receive_due() {
    execute<Hint::receive_due>();
    return window().arrival;
  }
  /// From now on `receive` lets records gather until a multiple of `cycles` of the clock, or until there are `records`
  /// of them; 0 cycles: it waits for the first one alone.
  void gather(std::uint32_t cycles, std::uint32_t records) { window().gather = {cycles, records}; }
  /// The message of the last arrival of kind `message`; valid until the next one.
  const protocol::MessageHeader& message() const { return window().message; }
  std::span<const std::byte> message_bytes() const { return {window().message_bytes.data(), window().message.bytes}; }
  /// The message's contents as a struct; fails the run where the message is shorter.
  template <class T>
  const T& message_as() {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= 8);
    if (message().bytes < sizeof(T)) fail(FaultCode::short_message, message().kind, message().bytes, sizeof(T));
    return *reinterpret_cast<const T*>(window().message_bytes.data());
  }

  /// Gives a NIU slot whose record has died back. The NIU learns of it at the next send or receive.
  /// At most as many as records arrived since then, so the list (64) is longer than it ever gets (16).
  void release(Slot slot) {
    NiuWindow& w = window();
    if (w.released >= w.release.size()) fail(FaultCode::release_list_full, w.released);
    w.release[w.released] = slot;
    ++w.released;
  }

  /// All slots of the last arrival, its first to be filled first again. The list must be empty.
  void release_arrival() {
    NiuWindow& w = window();
    if (w.released != 0) fail(FaultCode::release_list_full, w.released);
    const std::uint32_t count = w.arrival.count;
    for (std::uint32_t i = 0; i < count; ++i) w.release[i] = w.arrival.slots[count - 1 - i];
    w.released = count;
  }

  /// Tells the NIU where the record slots are. All slots must be free.
  void set_slots(std::uint32_t address, std::uint32_t bytes_each, std::uint32_t own, std::uint32_t niu) {
    window().slots = {address, bytes_each, own, niu};
    execute<Hint::set_slots>();
  }

  /// The PE's clock [cycles].
  std::uint64_t clock() {
    execute<Hint::clock>();
    return window().clock;
  }

  /// The program has ended; the run ends when all have.
  [[noreturn]] void halt() {
    execute<Hint::halt>();
    gate_.end();
  }
  /// Ends the run with a message that names this PE; what the details mean depends on the code.
  [[noreturn]] void fail(FaultCode code, std::uint32_t detail0 = 0, std::uint32_t detail1 = 0,
                         std::uint32_t detail2 = 0) {
    window().fault = {static_cast<std::uint32_t>(code), {detail0, detail1, detail2}};
    execute<Hint::fail>();
    gate_.end();
  }

  /// Cycles from here on belong to this phase, until it is left; phases may nest. Costs no cycles.
  template <Phase kPhase>
  void enter_phase() {
    gate_.mark<static_cast<std::int32_t>(Hint::enter_phase) + static_cast<std::int32_t>(kPhase)>(window());
  }
  template <Phase kPhase>
  void leave_phase() {
    gate_.mark<static_cast<std::int32_t>(Hint::leave_phase) + static_cast<std::int32_t>(kPhase)>(window());
  }

 private:
  template <Hint kHint>
  void execute() {
    gate_.execute<static_cast<std::int32_t>(kHint)>(window());
  }

  NiuPage* page_;
  Memory memory_;
  HintGate gate_;
};

/// Charges the cycles of a block of code to a phase of the profile: PhaseMark<Phase::shoot> mark(niu);
template <Phase kPhase>
class PhaseMark {
 public:
  /// The phase lasts as long as this object.
  explicit PhaseMark(Niu& niu) : niu_(niu) { niu_.enter_phase<kPhase>(); }
  ~PhaseMark() { niu_.leave_phase<kPhase>(); }
  PhaseMark(const PhaseMark&) = delete;
  PhaseMark& operator=(const PhaseMark&) = delete;

 private:
  Niu& niu_;
};

}  // namespace torolux::pe
