// SPDX-License-Identifier: MIT
// The network half of the machine while it runs: events in order of virtual time, each handed to the actor it is for.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/bus/bus.hpp"
#include "emulator/engines/engine/engine.hpp"
#include "emulator/frame_buffer/controller.hpp"
#include "emulator/host/host_actor.hpp"
#include "emulator/machine/call_stacks.hpp"
#include "emulator/machine/live_figures.hpp"
#include "emulator/machine/machine.hpp"
#include "emulator/machine/time_line.hpp"
#include "emulator/niu/network_side.hpp"
#include "emulator/snapshot/archive.hpp"
#include "emulator/time/bound_tree.hpp"
#include "emulator/time/event_queue.hpp"
#include "emulator/torus/torus.hpp"
#include "emulator/trace/machine_watch.hpp"
#include "emulator/trace/pacer.hpp"
#include "emulator/trace/record_watcher.hpp"

namespace torolux {

/// Single-threaded. PEs run elsewhere, or when it asks their engine to; they meet it in their channels only.
class Emulation final : private TorusClient, private BusClient, private HostClient, private EventWatcher {
 public:
  /// channels: zeroed, one per PE. stacks: for messages about faults. All references outlive this. phases: their names.
  Emulation(const MachineSetup& setup, const std::vector<NiuChannel*>& channels, CallStacks& stacks, Engine& engine,
            HostProgram& program, PhaseNames phases);

  /// Runs until the program has finished and the machine is empty, or until the set-up's end. attend: called at least
  /// some ten times a second, or as often as the setup's progress asks for; may throw to end the run. message_read:
  /// called after each message that the host has read; null: nobody. Throws MachineFailure.
  void run(const std::function<void(Cycles)>& attend, const std::function<void()>& message_read);
  /// The run has ended: time goes on with another program, which has the same kinds of records, and the same picture.
  void go_on_with(HostProgram& program);
  /// While nothing runs: the picture begins anew.
  void begin_picture(std::uint32_t width, std::uint32_t height, std::uint32_t layers);
  /// Before the run, which then goes on from what `save` of an equal machine has written. Throws InputError.
  void restore(SnapshotReader& archive);
  /// Waits until no PE can do more before something else happens.
  void let_rest();
  /// The same, but for PEs that take turns, of which what they have done is known; and no PE executes anything until
  /// let_go. So much may be saved.
  void hold_at_rest();
  void let_go();
  void save(SnapshotWriter& archive);
  bool has_failed() const { return !failure_.empty(); }
  void tell_to_stop();
  /// The run has ended: whoever watches is told the rest.
  void end_watch(Cycles end);

  /// Waits until no PE can do more before something else happens, so that the figures are exact.
  void fill_in(MachineFigures& figures);
  /// A line for all PEs that do the same in the same place, each with a line end in front.
  std::string where_pes_stand();
  /// What is known now, without waiting for anybody.
  void sample(LiveFigures& figures) const;
  const FrameBuffer& frame_buffer() const { return controller_.frame_buffer(); }
  const FrameChanges& frame_changes() const { return controller_.changes(); }
  Cycles now() const { return now_; }
  /// Time that the calling thread has slept for PEs [s of wall time].
  double slept_seconds() const { return slept_; }
  /// Time in the host's program [s of wall time].
  double program_seconds() const { return host_.program_seconds(); }
  /// A number that depends on every event so far: equal runs have equal ones.
  std::uint64_t trace_hash() const { return trace_hash_; }

 private:
  // ---- Scheduling ----
  void lend_to_near_pes();
  bool next_event(Event& event);
  void await(unsigned pe, Cycles wanted);
  Cycles end_of_turn(unsigned pe, Cycles time) const;
  void fetch_next_turn_ahead() const;
  void attend_now_and_then();
  void hold_until_let(Cycles next);
  bool at_rest(unsigned pe);
  // Figures (stages.cpp)
  void begin_stage(std::string_view name) override;
  void note(HostGauge gauge, double value) override;
  void note_host_busy();
  void count_kinds(const Block& block);
  MachineFigures network_figures(Cycles now);
  void fill_in_stages(MachineFigures& all, unsigned pe, const ProcessorMark& end) const;
  template <class Archive>
  void archive(Archive& archive);
  void archive_niu(SnapshotReader& archive, unsigned pe);
  void archive_niu(SnapshotWriter& archive, unsigned pe);
  bool empty() const;
  bool stops_before_end();
  std::string deadlock_report();
  std::string report_of(unsigned pe) const;

  // ---- Events ----
  void handle(const Event& event);
  void soon(const Event& event) override;
  void command(unsigned pe, const PendingCommand& command);
  void deliver(unsigned pe, BlockIndex block);
  void drop(unsigned pe, BlockIndex block);
  void bus_done(BlockIndex block);
  void host_message(BlockIndex block);
  void pixels_done(BlockIndex block);
  void copy_in(unsigned pe, BlockIndex block, bool from_bus);
  void copied(unsigned pe, BlockIndex block, bool from_bus);
  void slots_changed(unsigned pe);
  bool signal(EventKind kind, unsigned pe, std::uint8_t port, std::uint32_t value);
  void ask_for_slots(unsigned pe, HostQueue queue);
  void slots_asked(unsigned pe, HostQueue queue, std::uint32_t records);
  void grant_slots(unsigned pe);
  BusRequest first_request(unsigned pe) const;
  void host_queue(unsigned pe, BlockIndex block);
  void update_host();
  BusRequest host_request() const;
  BusSend take_of_host(BusRequest granted);
  void send_message(unsigned pe, BlockIndex block);
  void fail_program(unsigned pe, BlockIndex block);
  void fail_niu(unsigned pe, BlockIndex block);
  void fail(std::string text, const std::string& calls);
  void end_if_failed() const;

  // ---- TorusClient, BusClient ----
  void injected(unsigned pe, Cycles tail) override;
  bool accept(unsigned pe, BlockIndex block) override;
  void coming(unsigned pe) override;
  BusSend take(BusRequester requester, BusRequest granted) override;

  /// What belongs to a PE beside its NIU's account.
  struct PePart {
    BlockQueue outgoing;              // to the bus
    BlockIndex diverting = kNoBlock;  // in the divert buffer, or on its way there
    bool halted = false;
    std::uint64_t packets_sent = 0;
    std::uint64_t packets_delivered = 0;
  };

  // Sources of events, in the order in which ties are broken: PEs, routers (and what their NIUs do on the network's
  // side), bus, host, FBC, the routers' arbiters, the bus's arbiter: those decide at the end of a cycle.
  std::uint32_t pes_;
  CallStacks& stacks_;
  PhaseNames phases_;
  Engine& engine_;
  HostProgram* program_;
  EventQueue events_;
  BlockPool pool_;
  PeTimes times_;
  std::vector<NiuChannel*> channels_;
  std::vector<NiuNetworkSide> nius_;
  std::vector<PePart> parts_;
  Jitter jitter_;
  Torus torus_;
  Bus bus_;
  FrameBufferController controller_;
  HostActor host_;
  std::uint32_t signal_cycles_;
  RecordWatcher* record_watcher_;  // null: nobody
  Pacer* pacer_;                   // null: as fast as it goes
  std::function<void(Cycles)> attend_;
  std::uint32_t until_attend_ = 0;
  double attend_seconds_;  // of wall time, from one to the next
  double last_attended_ = 0;
  double slept_ = 0;
  bool resumed_ = false;
  bool stopped_ = false;  // before its end
  Cycles until_;          // kNever: to its end
  Cycles now_ = 0;
  std::uint64_t trace_hash_ = 0;
  std::uint64_t messages_to_host_ = 0;  // sent so far, on their way or read
  std::string failure_;                 // of the first PE that failed; the run ends once the host has read those
  /// Stages of the host's program so far; before: what the network's side had counted when it began.
  struct Stage {
    std::string name;
    MachineFigures before;

    template <class Archive>
    void archive(Archive& archive) {
      archive(name, before);
    }
  };
  std::vector<Stage> stages_;
  bool begun_ = false;  // the program has named the first
  TimeLine time_line_;
  Cycles bus_busy_ = 0, host_busy_ = 0;  // as far as they are in the time line
  Cycles cycles_per_pixel_;
  std::vector<KindFigures> kinds_;
  std::optional<MachineWatch> watch_;
};

}  // namespace torolux
