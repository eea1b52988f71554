// SPDX-License-Identifier: MIT
// The network's side of a NIU: takes the processor's commands in, keeps account of slots and buffers in virtual time,
// and hands arrivals over. Knows how long the processor will certainly do nothing.
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "emulator/machine/description.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/time/bound_tree.hpp"
#include "emulator/time/event_queue.hpp"
#include "emulator/torus/block.hpp"

namespace torolux {

/// A command as it stands in line until its time; its payload lies in a block.
struct PendingCommand {
  CommandKind kind;
  std::uint32_t released;
  BlockIndex block;  ///< kNoBlock: no payload
};

class NiuNetworkSide {
 public:
  /// channel: zeroed. Event source of the PE = pe.
  NiuNetworkSide(NiuChannel& channel, unsigned pe, unsigned pes, const MachineDescription& machine);

  // ---- Bounds and waiting; only the scheduler calls these ----

  /// Takes in what the processor has said. True: its bound has changed.
  bool refresh(EventQueue& events, BlockPool& pool, BoundTree& bounds);
  /// As of the last refresh, deliveries since taken into account. `running` unless it truly waits.
  WaitKind waits_for() const;
  /// Lets a processor in receive_if_any know that all arrivals before `horizon` are known. False: it knows already.
  bool publish_horizon(Cycles horizon);
  /// Sleeps until the processor's bound is later than `wanted`, or it waits, or some milliseconds have passed.
  void sleep_until_bound(Cycles wanted);
  void tell_to_stop();

  // ---- Commands ----

  PendingCommand next_command();
  bool has_command() const { return !commands_.empty(); }

  // ---- Record slots and control buffers ----

  void set_slots(std::uint32_t slots) { slots_ = slots; }
  std::uint32_t slots_used() const { return used_; }
  std::uint32_t slots_high_water() const { return high_water_; }
  bool has_slots(std::uint32_t records) const { return used_ + records <= slots_; }
  void reserve_slots(std::uint32_t records);  ///< only after has_slots
  void release_slots(std::uint32_t records);
  bool has_control_buffer() const { return control_used_ < control_buffers_; }
  void reserve_control_buffer() { ++control_used_; }
  void release_control_buffer() { --control_used_; }

  // ---- Towards the processor ----

  /// A packet or message, its room reserved, has come at `now`. The block belongs to the NIU from here on.
  void deliver(BlockIndex block, Cycles now, BlockPool& pool, BoundTree& bounds);
  void left_torus_queue(Cycles now, BoundTree& bounds) { left(channel_->torus_departures, now, bounds); }
  void left_bus_queue(Cycles now, BoundTree& bounds) { left(channel_->bus_departures, now, bounds); }

  const NiuChannel& channel() const { return *channel_; }
  std::uint64_t arrivals() const { return delivered_; }

 private:
  void drain(EventQueue& events, BlockPool& pool);
  void refill(BlockPool& pool);
  void push_arrival(const Block& block, Cycles time);
  void left(Departures& departures, Cycles now, BoundTree& bounds);
  void wake_processor();
  void may_go_on(Cycles now, BoundTree& bounds);

  struct Overflow {
    Cycles time;
    BlockIndex block;
  };

  NiuChannel* channel_;
  unsigned pe_;
  Cycles floor_ = kCommandCycles;  // no command with an earlier time
  std::uint64_t wait_ = 0;         // as of the last refresh
  std::uint64_t delivered_ = 0;
  std::uint32_t sends_ = 0;
  std::uint32_t slots_ = 0, used_ = 0, high_water_ = 0;
  std::uint32_t control_buffers_, control_used_ = 0;
  std::deque<PendingCommand> commands_;
  std::deque<Overflow> overflow_;  // delivered, but the ring was full
};

}  // namespace torolux
