// SPDX-License-Identifier: MIT
// The host in the machine: runs the host program in virtual time, keeps what it sends until the bus takes it, and
// sends diverted records back to their PEs.
#pragma once

#include <cstdint>
#include <deque>
#include <span>
#include <vector>

#include "emulator/host/host_clock.hpp"
#include "emulator/host/host_program.hpp"
#include "emulator/machine/description.hpp"
#include "emulator/niu/network_side.hpp"
#include "emulator/time/event_queue.hpp"
#include "emulator/time/ready_set.hpp"
#include "emulator/torus/block.hpp"

namespace torolux {

/// All that the host does it does one after the other, by its own clock; the bus takes what it has made meanwhile.
class HostActor final : public HostPort {
 public:
  HostActor(const MachineDescription& machine, HostProgram& program, std::vector<NiuNetworkSide>& nius,
            EventQueue& events, std::uint32_t source, BlockPool& pool);

  // ---- HostPort ----
  Cycles now() const override { return clock_.now(); }
  unsigned pes() const override { return static_cast<unsigned>(nius_.size()); }
  void work(HostWork what, std::uint64_t items) override { clock_.work(what, items); }
  void send_message(PeNumber pe, std::uint16_t kind, std::span<const std::byte> contents) override;
  void send_records(PeNumber pe, std::span<const std::byte> records, std::uint32_t record_bytes) override;
  std::size_t queued(PeNumber pe) const override { return lines_[pe].made; }

  // ---- The machine's side ----
  void start();
  /// A message or diverted records have come over the bus.
  void arrive(BlockIndex block, Cycles now);
  /// Event host_step: the next message.
  void step();
  /// Event host_queue: something made earlier is ready for the bus.
  void enqueue(unsigned pe, BlockIndex block);
  /// Slots or control buffers of a PE have become free, or taken.
  void room_changed(unsigned pe);
  /// Whether something is ready for which there is room.
  bool ready() const { return !ready_.empty(); }
  /// What goes over the bus next, its room reserved.
  BlockIndex take();

  bool idle() const { return inbox_.empty() && !stepping_; }
  std::size_t inbox() const { return inbox_.size(); }
  std::size_t waiting(unsigned pe) const { return lines_[pe].program.size() + lines_[pe].resend.size(); }
  const HostClock& clock() const { return clock_; }
  std::uint64_t records_diverted(unsigned pe) const { return lines_[pe].diverted; }

 private:
  struct Line {
    BlockQueue program;    // from the program, in its order
    BlockQueue resend;     // diverted records on their way back: apart, so that neither waits for the other
    std::size_t made = 0;  // of the program's: not yet taken by the bus
    std::uint64_t diverted = 0;
  };

  void queue_for(PeNumber pe, BlockIndex block);
  bool fits(unsigned pe, const BlockQueue& queue) const;
  void schedule_step(Cycles now);

  HostClock clock_;
  HostProgram& program_;
  std::vector<NiuNetworkSide>& nius_;
  EventQueue& events_;
  std::uint32_t source_;
  BlockPool& pool_;
  std::vector<Line> lines_;
  ReadySet ready_;  // PEs for which there is something, and room
  std::deque<BlockIndex> inbox_;
  bool stepping_ = false;  // a host_step is scheduled
  std::uint32_t numbers_ = 0;
  unsigned next_pe_ = 0;  // round robin
};

}  // namespace torolux
