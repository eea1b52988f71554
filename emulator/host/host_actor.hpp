// SPDX-License-Identifier: MIT
// The host in the machine: runs the host program in virtual time, keeps what it sends until the bus takes it, and
// sends diverted records back to their PEs.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <optional>
#include <span>
#include <vector>

#include "emulator/clock_seconds.hpp"
#include "emulator/description/description.hpp"
#include "emulator/host/host_clock.hpp"
#include "emulator/host/host_program.hpp"
#include "emulator/host/host_queue.hpp"
#include "emulator/time/event_queue.hpp"
#include "emulator/time/ready_set.hpp"
#include "emulator/torus/block.hpp"

namespace torolux {

/// Who counts what the host's program tells of itself, by the host's clock.
class HostClient {
 public:
  virtual ~HostClient() = default;
  virtual void begin_stage(std::string_view name) = 0;
  virtual void note(HostGauge gauge, double value) = 0;
};

/// All that the host does it does one after the other, by its own clock; the bus takes what it has made meanwhile.
class HostActor final : public HostPort {
 public:
  HostActor(const MachineDescription& machine, HostProgram& program, unsigned pes, EventQueue& events,
            std::uint32_t source, BlockPool& pool);

  // ---- HostPort ----
  Cycles now() const override { return clock_.now(); }
  unsigned pes() const override { return static_cast<unsigned>(lines_.size()); }
  void work(HostWork what, std::uint64_t items) override { clock_.work(what, items); }
  void send_message(PeNumber pe, std::uint16_t kind, std::span<const std::byte> contents) override;
  void broadcast(std::uint16_t kind, std::span<const std::byte> contents) override;
  void send_records(PeNumber pe, std::span<const std::byte> records, std::uint32_t record_bytes) override;
  void read_pixels(const FrameRead& read) override;
  void begin_stage(std::string_view name) override { client_->begin_stage(name); }
  void note(HostGauge gauge, double value) override { client_->note(gauge, value); }
  std::size_t queued(PeNumber pe) const override { return lines_[pe].made + broadcasts_made_; }

  // ---- The machine's side ----
  void start(HostClient& client);
  /// The program has finished, and the machine is empty: from now on another one, which is still to be started.
  void go_on_with(HostProgram& program, Cycles now);
  /// Instead of that, where the program goes on.
  void resume(HostClient& client) { client_ = &client; }
  /// A message or diverted records have come over the bus, or sums that were read.
  void arrive(BlockIndex block, Cycles now);
  /// Event host_step: the next message.
  void step();
  /// Event host_queue: something made earlier waits for room, in this queue or for a broadcast made before it.
  HostQueue enqueue(unsigned pe, BlockIndex block);
  /// Records for which slots must be asked for now; 0: none, or it has been done. Then they are asked for.
  std::uint32_t ask_for_slots(unsigned pe, HostQueue queue);
  /// The first packet of a queue has its slots.
  void slots_granted(unsigned pe, HostQueue queue);
  /// A control buffer that the host had used is free again.
  void control_buffer_free(unsigned pe);
  /// Whether something is ready for which there is room at the PEs.
  bool ready() const { return !ready_.empty() || (barrier_is_next() && !reads_next() && full_ == 0); }
  /// Or a read, for which the frame buffer controller needs a place.
  bool ready_to_read() const { return ready_.empty() && barrier_is_next() && reads_next(); }
  /// What goes over the bus next, and the queue that it stood in; pe, queue: of a broadcast or a read, any.
  struct Taken {
    BlockIndex block;
    unsigned pe;
    HostQueue queue;
  };
  Taken take();
  /// The same where a place of the frame buffer controller was asked for.
  BlockIndex take_read() { return behind_.pop(pool_); }
  /// A broadcast or a read has been taken: the next that waited for it stands in the line of this PE. To be called
  /// until there is none.
  std::optional<unsigned> let_through();

  bool idle() const { return inbox_.empty() && !stepping_; }
  std::size_t inbox() const { return inbox_.size(); }
  std::uint64_t messages_read() const { return messages_read_; }  ///< by the program, so far
  std::size_t waiting(unsigned pe) const { return lines_[pe].queues[0].size() + lines_[pe].queues[1].size(); }
  /// Broadcasts and reads, and what waits for them.
  std::size_t waiting_for_all() const { return behind_.size(); }
  const HostClock& clock() const { return clock_; }
  double program_seconds() const { return program_seconds_; }  ///< wall time that the program took
  std::uint64_t records_diverted(unsigned pe) const { return lines_[pe].diverted; }
  /// All of it that a run changes; not the program's own.
  template <class Archive>
  void archive(Archive& archive) {
    archive(clock_, lines_, ready_, behind_, ahead_, full_, broadcasts_made_, inbox_, stepping_, messages_read_,
            numbers_, next_pe_);
  }

 private:
  /// Slots for the first packet of a queue.
  enum class Slots : std::uint8_t { none, asked, granted };
  struct Line {
    std::array<BlockQueue, kHostQueues> queues;
    std::array<Slots, kHostQueues> slots{};
    std::uint32_t control_buffers = 0;  // free ones of the NIU, as far as the host knows
    std::size_t made = 0;               // of the program's: not yet taken by the bus
    std::uint64_t diverted = 0;
  };

  BlockIndex make_message(std::uint16_t destination, std::uint16_t kind, std::span<const std::byte> contents);
  void queue_for(std::uint16_t destination, BlockIndex block);
  void put(unsigned pe, HostQueue queue, BlockIndex block);
  bool fits(unsigned pe, HostQueue queue) const;
  bool barrier_is_next() const { return ahead_ == 0 && !behind_.empty(); }
  bool reads_next() const { return pool_[behind_.front()].destination == protocol::kFrameBuffer; }
  bool is_barrier(BlockIndex block) const;
  void tell_program(const Block& block);
  /// Calls it, and counts the time.
  template <class Call>
  void in_program(Call call) {
    const double begin = clock_seconds(CLOCK_MONOTONIC);
    call();
    program_seconds_ += clock_seconds(CLOCK_MONOTONIC) - begin;
  }
  BlockIndex take_broadcast();
  void use_control_buffer(Line& line);
  void update(unsigned pe);
  void schedule_step(Cycles now);

  HostClient* client_ = nullptr;
  HostClock clock_;
  HostProgram* program_;
  EventQueue& events_;
  std::uint32_t source_;
  BlockPool& pool_;
  std::vector<Line> lines_;
  ReadySet ready_;  // PEs for which there is something, and room
  // A broadcast is a barrier: first it waits until the program's queues are empty, then for its control buffers. So is
  // a read, which waits for a place of the frame buffer controller.
  BlockQueue behind_;                // the first barrier, and all that the program has made since
  std::size_t ahead_ = 0;            // of the program, in the PEs' lines
  unsigned full_ = 0;                // PEs without a free control buffer, as far as the host knows
  std::size_t broadcasts_made_ = 0;  // not yet taken by the bus
  std::deque<BlockIndex> inbox_;
  bool stepping_ = false;  // a host_step is scheduled
  std::uint64_t messages_read_ = 0;
  double program_seconds_ = 0;
  std::uint32_t numbers_ = 0;
  unsigned next_pe_ = 0;  // round robin
};

}  // namespace torolux
