// SPDX-License-Identifier: MIT
// The channel between the two sides of a NIU. Commands leave the processor's side, arrivals enter it; both carry
// virtual times, so that nothing depends on when either side really runs. One per PE, in shared memory.
#pragma once

#include <array>
#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "emulator/niu/byte_ring.hpp"
#include "emulator/time/slices.hpp"
#include "emulator/torus/payload.hpp"
#include "emulator/torus/record_kinds.hpp"
#include "firmware/protocol/hints.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {

/// A time that never comes.
inline constexpr std::uint64_t kNever = std::numeric_limits<std::uint64_t>::max();
/// Greatest length of a NIU's outgoing queues.
inline constexpr std::uint32_t kMostSendQueue = 256;
/// Most record slots of a NIU.
inline constexpr std::uint32_t kMostNiuSlots = 4096;
/// A wake-up: the clock of a sleeping processor becomes `wake`; it is for the arrivals up to `last`.
struct Gathering {
  std::uint64_t wake;
  std::uint64_t last;
};
/// For an arrival at `time`, if nothing else wakes the processor: at a tick, for what had come some time before it.
/// Between the two all that the processor will see is known, so it need not wait for others.
constexpr Gathering gathering(std::uint64_t time, std::uint32_t cycles) {
  if (cycles == 0) return {time, time};
  const std::uint64_t lead = cycles / 4;
  const std::uint64_t wake = ((time + lead - 1) / cycles + 1) * cycles;
  return {wake, wake - lead};
}

/// What a processor that waits in a HINT waits for. A HINT may wait for one thing after another.
enum class WaitReason : std::uint8_t {
  arrivals,     ///< to be woken from `receive`
  torus_place,  ///< in the outgoing queue to the torus
  bus_place,    ///< in the outgoing queue to the bus
  copy,         ///< for a copy engine: to be free for what is sent, or to have copied the message received
  count
};
inline constexpr std::size_t kWaitReasons = static_cast<std::size_t>(WaitReason::count);
inline constexpr std::array<std::string_view, kWaitReasons> kWaitReasonNames = {"arrivals", "torus_place", "bus_place",
                                                                                "copy"};
using WaitCycles = std::array<std::uint64_t, kWaitReasons>;  ///< by WaitReason

/// Size of the rings between the two sides. The more there is room, the further a processor runs ahead of the network.
inline constexpr std::uint32_t kMostRingBytes = 128U << 10U;
/// In a machine of many PEs; and for processors in this process, whose data the host's caches then hold.
inline constexpr std::uint32_t kLeastRingBytes = 16U << 10U;
inline constexpr unsigned kManyPes = 64;
/// From the end of a HINT to the moment when the network side sees what it did [cycles]: the lookahead of this edge.
inline constexpr std::uint64_t kCommandCycles = 1;

/// Of a copy engine that moves so many bytes in a cycle; 0: it takes no time.
constexpr std::uint64_t copy_cycles(std::uint64_t bytes, std::uint32_t bytes_per_cycle) {
  return bytes_per_cycle == 0 ? 0 : (bytes + bytes_per_cycle - 1) / bytes_per_cycle;
}

enum class CommandKind : std::uint16_t {
  send_records,  ///< contents: the records
  send_message,  ///< contents: of the message
  release,       ///< only `released` counts
  received,      ///< a message has been received: its control buffer is free
  set_slots,     ///< contents: SlotsCommand
  halt,
  fail,   ///< contents: protocol::Fault, from the program
  fault,  ///< contents: NiuFault, from this side of the NIU
};

/// Processor -> network. `time` of successive commands never falls.
struct Command {
  std::uint64_t time;  ///< [cycles] when what is sent has been copied or the HINT has ended, plus kCommandCycles
  CommandKind kind;
  std::uint16_t destination;   ///< send_*
  std::uint16_t message_kind;  ///< send_message
  std::uint16_t records;       ///< send_records: 1..kMostRecordsPerPacket
  std::uint16_t released;      ///< NIU slots that became free
  std::uint16_t lent;          ///< bytes of `payload`
  std::uint32_t bytes;         ///< that follow in the ring
  std::uint64_t kinds = 0;     ///< of the records, 4 bits for each, the first one's the lowest: kind + 1; 0: not told
  /// The contents, where both sides are in one process and one was free; with the command it becomes the network's.
  /// nullptr: they follow in the ring.
  Payload* payload = nullptr;
};
static_assert(sizeof(Command) == 40 && kMostNiuSlots < 1U << 16U && kMostBlockBytes < 1U << 16U);
/// Kinds of records that Command::kinds can tell.
inline constexpr std::size_t kMostToldKinds = 15;
static_assert(protocol::kMostRecordsPerPacket * 4 <= 64);

struct SlotsCommand {
  std::uint32_t niu;    ///< slots of the NIU
  std::uint32_t bytes;  ///< of a record
};

/// What a program may do wrong with its NIU; each ends the run. details as listed.
enum class NiuFaultCode : std::uint32_t {
  unknown_hint = 1,       ///< immediate
  bad_count,              ///< records in a packet, bytes of a record
  bad_slot,               ///< slot, own slots, NIU's slots
  slot_not_in_use,        ///< slot
  bad_destination,        ///< destination
  bad_address,            ///< address, bytes
  bad_message_length,     ///< bytes
  bad_slots,              ///< address, own, NIU's (set_slots)
  slots_in_use,           ///< slots in use (set_slots)
  too_many_released,      ///< released
  phase_mismatch,         ///< phase, innermost open phase or kPhases, 1: it was entered with all open, 0: left
  too_long_without_hint,  ///< limit (low, high word), pc or 0
  no_trap_handler,        ///< mcause, mepc, mtval; or kUnknownTrap
  wait_for_interrupt      ///< pc: of `wfi`
};
inline constexpr std::uint32_t kUnknownTrap = 0xFFFF'FFFFU;
struct NiuFault {
  NiuFaultCode code;
  std::uint32_t detail[3];
};
static_assert(sizeof(NiuFault) == 16);

/// Network -> processor.
struct Arrival {
  std::uint64_t time;          ///< [cycles] when it has come
  std::uint16_t kind;          ///< protocol::ArrivalKind
  std::uint16_t source;        ///< PE or kHost
  std::uint16_t count;         ///< records
  std::uint16_t message_kind;  ///< message
  std::uint32_t bytes;         ///< that follow in the ring: records or contents
  std::uint8_t stage;          ///< of the host's program, counted from 0, when it came
  bool shared = false;         ///< other PEs hold `payload`, too
  std::uint16_t lent = 0;      ///< bytes of `payload`
  Payload* payload = nullptr;  ///< records or contents, likewise; it becomes the processor's, who gives it back
};
static_assert(sizeof(Arrival) == 32);

/// Of a Command or an Arrival in its ring, wherever they are; valid until it is popped.
template <class Entry>
std::span<const std::byte> contents_of(const Entry& entry) {
  if (entry.payload != nullptr) return std::span(entry.payload->bytes).first(entry.lent);
  return payload_behind(entry);
}

/// What a processor waits for. While it waits, no command will come until the network side gives it that.
enum class WaitKind : std::uint8_t {
  running,      ///< for nothing
  receive,      ///< to be woken when it has taken `count` arrivals
  poll,         ///< for an arrival, or for the horizon to pass `count`
  torus_place,  ///< for `count` packets to have left the outgoing queue
  bus_place,    ///< for `count` messages to have left the outgoing queue
  halted,       ///< for ever
  until,        ///< likewise: the run ends before its HINT
};
constexpr std::uint64_t pack_wait(WaitKind kind, std::uint64_t count) {
  return (count << 3U) | static_cast<std::uint64_t>(kind);
}
constexpr WaitKind wait_kind(std::uint64_t wait) {
  return static_cast<WaitKind>(wait & 7U);
}
constexpr std::uint64_t wait_count(std::uint64_t wait) {
  return wait >> 3U;
}

/// When packets left an outgoing queue; written by the network side.
struct Departures {
  std::atomic<std::uint64_t> count;
  std::uint64_t mask;                                           ///< 2^i - 1, at least the queue's places - 1
  std::array<std::atomic<std::uint64_t>, kMostSendQueue> time;  ///< of number n at n & mask: as few lines as needed

  void set_places(std::uint32_t places) { mask = std::bit_ceil(places) - 1; }
  /// Number n, which is how many have left before.
  void add(std::uint64_t n, std::uint64_t when) {
    time[n & mask].store(when, std::memory_order_relaxed);
    count.store(n + 1, std::memory_order_release);
  }
  /// What `add` of number n needs, into the caches. places: as set.
  void fetch_ahead(std::uint64_t n, std::uint32_t places) const {
    __builtin_prefetch(&count, 1);
    __builtin_prefetch(&time[n & (std::bit_ceil(places) - 1)], 1);
  }
  /// Number n must have left, and number n + places not yet have been sent.
  std::uint64_t when(std::uint64_t n) const { return time[n & mask].load(std::memory_order_relaxed); }
};

/// Most stages of a host's program.
inline constexpr std::uint32_t kMostStages = 8;

/// What a processor has done up to some moment; the difference of two is what it has done between them.
struct ProcessorMark {
  std::uint64_t clock;
  std::uint64_t instructions;
  std::uint64_t copied;  ///< as in the channel, like the two that follow
  WaitCycles waits;
  std::array<std::uint64_t, protocol::kPhases> phase_cycles;
};

/// What only the processor's side uses; here so that its owner may be any engine. What each HINT needs comes first.
struct ProcessorState {
  std::uint64_t last_command;   ///< time of the last command
  std::uint64_t copy_free;      ///< clock from which the outgoing copy engine is free
  std::uint64_t packets_sent;   ///< into the torus queue
  std::uint64_t messages_sent;  ///< into the bus queue
  std::uint64_t gather_end;     ///< arrivals up to here belong to the last wake-up
  std::uint64_t last_hint;      ///< clock at the end of the last HINT
  std::uint64_t phase_begin;    ///< busy cycles at the last marker
  std::uint64_t waited;         ///< [cycles] of the clock, for all reasons together
  std::uint64_t busy_since;     ///< clock at the end of the last wait
  std::uint32_t gathered;       ///< records of the last wake-up so far
  std::uint32_t stage;          ///< of the last arrival taken
  std::uint32_t slots_address, slot_bytes, own_slots, niu_slots;
  std::uint32_t slots_free;
  std::uint32_t phase_depth;
  std::array<std::uint8_t, protocol::kPhases> phases;  ///< open ones, innermost last
  std::uint16_t first_free;                            ///< index of a NIU slot, counted from own_slots
  std::array<std::uint16_t, kMostNiuSlots> next_free;  ///< or kSlotInUse
  Slices<std::uint64_t> busy;                          ///< busy cycles over time, up to busy_since
  std::array<ProcessorMark, kMostStages> marks;        ///< when its first arrival of each stage had been taken
};
inline constexpr std::uint16_t kSlotInUse = 0xFFFF;
inline constexpr std::uint16_t kNoSlot = 0xFFFE;

struct NiuChannel {
  // Set before the start.
  std::uint32_t torus_queue;  ///< places in the outgoing queue to the torus, 1..kMostSendQueue
  std::uint32_t bus_queue;
  std::uint32_t pes;
  std::uint32_t copy_bytes;  ///< in a cycle of a copy engine; 0: copies take no time
  std::uint64_t most_cycles_between_hints;
  std::uint64_t until;        ///< no HINT happens at this clock or later; 0: all do
  std::uint32_t ring_bytes;   ///< there is memory for so many in each ring; 0: kMostRingBytes
  std::uint32_t state_log;    ///< bytes from here to its StateLog; 0: nobody watches
  std::uint32_t takes_turns;  ///< 1: its bound tells its clock, not when its next command may come at the earliest
  std::uint32_t near;         ///< 1: the processor is in the emulator's process
  PayloadPool* payloads;      ///< of a near one, from the network's side; nullptr: all contents go through the rings
  const RecordKinds* record_kinds;  ///< likewise; nullptr: kinds are not told

  // Written by the processor's side.
  alignas(64) std::atomic<std::uint64_t> bound;  ///< no command with an earlier time will come
  std::atomic<std::uint64_t> wait;               ///< pack_wait
  std::atomic<std::uint64_t> clock;              ///< at the end of the last HINT, or at the beginning of one that waits
  std::array<std::atomic<std::uint64_t>, kWaitReasons> waits;  ///< [cycles] of `clock` spent waiting, by WaitReason
  std::atomic<std::uint64_t> copied;                           ///< [cycles] of the outgoing copy engine
  std::atomic<std::uint64_t> instructions;
  std::atomic<std::uint64_t> taken;  ///< arrivals, so far
  std::array<std::atomic<std::uint64_t>, protocol::kPhases> phase_cycles;

  std::atomic<std::uint32_t> gather_cycles, gather_records;  ///< NiuWindow::gather when it began to receive

  // The scheduler sleeps on network_signal; whoever reaches a bound beyond `wanted` wakes it and sets kNever.
  alignas(64) std::atomic<std::uint64_t> wanted;
  std::atomic<std::uint32_t> network_signal;

  // The processor sleeps on processor_signal, or until its waker is called, after it has set `asleep`.
  alignas(64) std::atomic<std::uint32_t> asleep;
  std::atomic<std::uint32_t> processor_signal;
  std::atomic<std::uint32_t> stopping;
  std::atomic<std::uint64_t> horizon;    ///< all arrivals with earlier times have been pushed
  std::atomic<std::uint64_t> wakes;      ///< arrivals that had been taken when the last wake-up was due, plus one
  std::atomic<std::uint64_t> wake_time;  ///< of that; written before `wakes`

  alignas(64) Departures torus_departures;
  alignas(64) Departures bus_departures;
  alignas(64) ProcessorState processor;
  ByteRing<Command, kMostRingBytes, 2 * kRingBytes> commands;
  ByteRing<Arrival, kMostRingBytes, kRingBytes + kMostRingBytes> arrivals;
  alignas(64) std::array<std::byte, std::size_t{2} * kMostRingBytes> rings;  ///< the last: it need not be there whole

  /// Each ring uses so many bytes: a power of two.
  void set_ring_bytes(std::uint32_t bytes) {
    commands.set_bytes(bytes, 0);
    arrivals.set_bytes(bytes, kMostRingBytes - bytes);
  }
};
static_assert(offsetof(NiuChannel, rings) - offsetof(NiuChannel, commands) == 2 * kRingBytes);
static_assert(offsetof(NiuChannel, rings) - offsetof(NiuChannel, arrivals) == kRingBytes);
/// Of a channel whose rings have so many bytes each.
constexpr std::size_t channel_bytes(std::uint32_t ring_bytes) {
  return offsetof(NiuChannel, rings) + std::size_t{2} * ring_bytes;
}

/// When the next command takes effect, if it is ready at this clock: commands stay in their order.
inline std::uint64_t command_time(ProcessorState& state, std::uint64_t clock) {
  state.last_command = state.last_command > clock + kCommandCycles ? state.last_command : clock + kCommandCycles;
  return state.last_command;
}
static_assert(channel_bytes(kLeastRingBytes) <= 62U * 1024U);

}  // namespace torolux
