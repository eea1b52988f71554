// SPDX-License-Identifier: MIT
// The network's side of a NIU: takes the processor's commands in, keeps account of slots and buffers in virtual time,
// and hands arrivals over. Knows how long the processor will certainly do nothing.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "emulator/description/description.hpp"
#include "emulator/host/host_queue.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/channel_archive.hpp"
#include "emulator/niu/state_log.hpp"
#include "emulator/niu/waker.hpp"
#include "emulator/time/bound_tree.hpp"
#include "emulator/time/event_queue.hpp"
#include "emulator/time/fifo.hpp"
#include "emulator/torus/block.hpp"

namespace torolux {

/// A command as it stands in line until its time: its event has all of it, or the block with its payload.
struct PendingCommand {
  CommandKind kind;
  std::uint32_t released;
  BlockIndex block;  ///< kNoBlock: no payload

  /// As drain made it of what came through the ring.
  PendingCommand(const Event& event, const BlockPool& pool)
      : kind(static_cast<CommandKind>(event.port)), block(block_of(event)) {
    released = kind == CommandKind::release ? event.block : block != kNoBlock ? pool[block].released : 0;
  }
  static BlockIndex block_of(const Event& event) {
    return static_cast<CommandKind>(event.port) == CommandKind::release ? kNoBlock : event.block;
  }
};

/// What the scheduler knows of each PE. Both are kNever where nothing happens before the network side acts.
struct PeTimes {
  BoundTree bounds;    ///< no command with an earlier time will come
  BoundTree releases;  ///< once everything before is known, a PE that waits for just that may go on
};

/// What is the same on both sides, before the start. channel: zeroed. on_thread: its processor runs in this process, or
/// on another rank.
void set_up_channel(NiuChannel& channel, unsigned pes, const MachineDescription& machine, bool on_thread);

/// Its members stand in lines of the caches by who needs them together: there are a thousand of these.
class alignas(64) NiuNetworkSide {
 public:
  /// channel: zeroed. Event source of the PE = pe. waker: none where the processor sleeps on its channel.
  NiuNetworkSide(NiuChannel& channel, unsigned pe, unsigned pes, const MachineDescription& machine,
                 ProcessorWaker* waker);

  // ---- Bounds and waiting; only the scheduler calls these ----

  /// Takes in what the processor has said. True: its times have changed.
  bool refresh(EventQueue& events, BlockPool& pool, PeTimes& times) {
    return has_news() && take_in(events, pool, times);
  }
  /// As of the last refresh, deliveries since taken into account. `running` unless it truly waits.
  WaitKind waits_for() const {
    const WaitKind kind = wait_kind(wait_);
    return kind == WaitKind::running || waits(kind, wait_count(wait_)) ? kind : WaitKind::running;
  }
  /// Everything before `horizon` is known: the processor, which waits for that, goes on.
  void release(Cycles horizon, PeTimes& times);
  /// Of a processor that waits for a horizon: whether its release is among the times. Else it goes on once its bound is
  /// the least of all, which is later than what it waits for; for one that runs only when the scheduler has nothing
  /// else to do.
  void tell_polls(bool tells, PeTimes& times) {
    tells_polls_ = tells;
    set_times(times);
  }
  /// The same for one that does not wait, but may ask.
  void publish_horizon(Cycles horizon);
  /// Before the scheduler waits for a processor that may go on. What this side writes does not wait to be seen (that is
  /// dear where it has to be fetched), so a processor that just then fell asleep may not have been woken.
  void wake_if_overlooked();
  /// Sleeps until the processor's bound is later than `wanted`, or it waits, or some milliseconds have passed.
  void sleep_until_bound(Cycles wanted);
  void tell_to_stop();

  // ---- Record slots and control buffers ----

  void set_slots(std::uint32_t slots) { slots_ = slots; }
  std::uint32_t slots_used() const { return used_; }
  std::uint32_t slots_high_water() const { return high_water_; }
  bool has_slots(std::uint32_t records) const { return used_ + records <= slots_; }
  void reserve_slots(std::uint32_t records);  ///< only after has_slots
  void release_slots(std::uint32_t records);
  void release_control_buffer() { --control_used_; }

  // ---- Receive buffers, and the engine that copies from them into slots ----

  bool has_receive_buffer() const { return receiving_ < receive_buffers_; }
  void reserve_receive_buffer();
  void release_receive_buffer() { --receiving_; }
  std::uint32_t receive_buffers_used() const { return receiving_; }
  std::uint32_t receive_buffers_high_water() const { return receiving_high_water_; }
  /// A packet with so many bytes of records lies in a buffer at `now`: when it has been copied.
  Cycles copy_in(std::uint32_t bytes, Cycles now);
  Cycles copy_in_cycles() const { return copy_in_cycles_; }

  // ---- Slots for the host's packets; one packet at a time, as the buffer that the bus fills holds one ----

  /// The host wants slots for the first packet of a queue.
  void ask_for_slots(HostQueue queue, std::uint32_t records) { asked_[static_cast<std::size_t>(queue)] = records; }
  /// Reserves slots and buffer for one of the host's queues, diverted records first; nothing where there is no room.
  std::optional<HostQueue> grant_slots();
  void release_bus_buffer() { bus_buffer_used_ = false; }

  // ---- Towards the processor ----

  /// A packet will soon be delivered, or a command take effect: what that needs here, fetched into the caches
  /// meanwhile.
  void fetch_ahead() const {
    __builtin_prefetch(&slots_, 1);
    __builtin_prefetch(&channel_, 1);
    __builtin_prefetch(&gathered_, 1);
    __builtin_prefetch(&horizon_, 1);
  }
  /// The processor will soon be asked what it has done, and go on: what that needs of its channel. The channel is
  /// given, since what names it here may have to be fetched itself.
  static void fetch_turn_ahead(const NiuChannel& channel) {
    __builtin_prefetch(&channel.bound, 1);
    __builtin_prefetch(&channel.asleep, 1);
    __builtin_prefetch(&channel.processor, 1);
    channel.commands.fetch_ahead();
    channel.arrivals.fetch_ahead();
  }
  /// The same of the channel, for a packet that is about to be delivered; after fetch_ahead.
  void fetch_arrivals_ahead() const {
    channel_->arrivals.fetch_ahead();
    __builtin_prefetch(&channel_->wait);
    gathered_.fetch_ahead();
  }
  /// And for one that is about to leave the outgoing queue.
  void fetch_departures_ahead() const { channel_->torus_departures.fetch_ahead(departed_torus_, torus_places_); }
  /// A packet or message, its room reserved, has come at `now`. The block belongs to the NIU from here on.
  void deliver(BlockIndex block, Cycles now, BlockPool& pool, PeTimes& times);
  /// The same of a message that others get, too, between BlockPool::begin_sharing and end_sharing: the block stays the
  /// caller's.
  void deliver_copy(const Block& message, Cycles now, BlockPool& pool, PeTimes& times);
  /// A place in an outgoing queue comes free at `when`, which is not before now.
  void left_torus_queue(Cycles when, PeTimes& times) { left(channel_->torus_departures, departed_torus_, when, times); }
  void left_bus_queue(Cycles when, PeTimes& times) { left(channel_->bus_departures, departed_bus_, when, times); }

  /// What comes from now on belongs to this stage of the host's program.
  void set_stage(std::uint32_t stage) { stage_ = static_cast<std::uint8_t>(stage); }

  /// What the processor tells of its states goes there, as far as its log has come at each refresh. states: outlives
  /// this.
  void watch(Fifo<StateChange>* states) { states_ = states; }
  /// The same after the run, which ended at `end`; only while the processor waits.
  void finish_states(Cycles end);

  const NiuChannel& channel() const { return *channel_; }
  // All that a run changes on both sides of the NIU; only while the processor waits, and as of the last refresh.

  /// This side; the channel follows it.
  void save(SnapshotWriter& archive) { archive_own(archive); }
  /// Of a processor of this process.
  void save_channel(SnapshotWriter& archive) const;
  /// Both. pool: restored.
  void restore(SnapshotReader& archive, BlockPool& pool);
  /// Whether all that is to be told to a processor of another rank has been taken out of the channel.
  bool is_told() const { return !far_ || channel_->arrivals.empty(); }
  /// Whether all that was delivered has been taken, as of the last refresh.
  bool nothing_gathered() const { return gathered_.empty(); }

 private:
  template <class Archive>
  void archive_own(Archive& archive) {
    archive(slots_, used_, high_water_, receiving_, receiving_high_water_, asked_, bus_buffer_used_, copy_free_,
            copy_in_cycles_, floor_, bound_, wait_, taken_, wakes_, stage_, gathered_, overflow_, horizon_,
            departed_torus_, departed_bus_, sends_, control_used_);
  }
  /// Whether the processor has said anything since the last refresh, or something waits that a refresh may do.
  bool has_news() const {
    // In the order in which `take_in` reads them.
    return channel_->wait.load(std::memory_order_seq_cst) != wait_ ||
           channel_->bound.load(std::memory_order_acquire) != bound_ || !channel_->commands.empty() ||
           channel_->taken.load(std::memory_order_relaxed) != taken_ || !overflow_.empty() || states_ != nullptr;
  }
  bool waits(WaitKind kind, std::uint64_t count) const;
  bool take_in(EventQueue& events, BlockPool& pool, PeTimes& times);
  void drain(EventQueue& events, BlockPool& pool);
  bool drain_states();
  void refill(BlockPool& pool);
  bool goes_into_ring(const Block& block) const { return overflow_.empty() && has_room_for(block); }
  bool has_room_for(const Block& block) const { return channel_->arrivals.has_room(lends(block) ? 0 : block.bytes); }
  /// Whether the processor gets the payload itself, and no copy.
  bool lends(const Block& block) const { return channel_->payloads != nullptr && block.contents != nullptr; }
  void gather(const Block& block, Cycles now);
  Arrival arrival_of(const Block& block, Cycles time, std::uint8_t stage) const;
  void push(const Arrival& arrival, const Block& block);
  void push_arrival(Block& block, Cycles time, std::uint8_t stage);
  void arrived(PeTimes& times);
  void left(Departures& departures, std::uint64_t& departed, Cycles when, PeTimes& times);
  void wake_processor();
  void signal_processor();
  bool set_times(PeTimes& times) const;
  Gathering next_wake() const;
  WaitKind says() const;

  struct Overflow {
    Cycles time;
    BlockIndex block;
    std::uint8_t stage;
  };

  /// An arrival that the processor has not taken.
  struct Gathered {
    Cycles time;
    std::uint32_t records;  // 0: a message
  };

  // Accounts of slots and buffers.
  std::uint32_t slots_ = 0, used_ = 0, high_water_ = 0;
  std::uint32_t receive_buffers_, receiving_ = 0, receiving_high_water_ = 0;
  std::uint32_t copy_bytes_;                        // in a cycle; 0: copies take no time
  std::array<std::uint32_t, kHostQueues> asked_{};  // slots, by HostQueue
  bool bus_buffer_used_ = false;
  Cycles copy_free_ = 0, copy_in_cycles_ = 0;
  // Waits.
  alignas(64) NiuChannel* channel_;
  ProcessorWaker* waker_;
  Cycles floor_ = kCommandCycles;  // no command with an earlier time
  Cycles bound_ = kCommandCycles;  // as of the last refresh, like the two that follow
  std::uint64_t wait_ = 0;
  std::uint64_t taken_ = 0;
  std::uint64_t wakes_ = 0;  // as in the channel
  unsigned pe_;
  std::uint8_t stage_ = 0;
  bool tells_polls_ = true;
  // Arrivals.
  alignas(64) Fifo<Gathered> gathered_;  // numbers taken_ and up
  Fifo<Overflow> overflow_;              // delivered, but the ring was full
  // As in the channel, which need not be fetched for it.
  alignas(64) std::uint64_t horizon_ = 0;
  std::uint64_t departed_torus_ = 0, departed_bus_ = 0;
  std::uint32_t torus_places_;
  std::uint32_t sends_ = 0;
  std::uint32_t control_buffers_, control_used_ = 0;
  bool far_;                             // the waker is told of all that is new
  Fifo<StateChange>* states_ = nullptr;  // nobody watches
};

}  // namespace torolux
