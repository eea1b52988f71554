// SPDX-License-Identifier: MIT
// A whole Torolux: PEs on an engine, torus, system bus, host, frame buffer controller, in virtual time.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "emulator/bus/bus_figures.hpp"
#include "emulator/description/description.hpp"
#include "emulator/engines/engine/debugging.hpp"
#include "emulator/engines/engine_names.hpp"
#include "emulator/engines/image/image_set.hpp"
#include "emulator/frame_buffer/frame_changes.hpp"
#include "emulator/host/host_program.hpp"
#include "emulator/machine/live_figures.hpp"
#include "emulator/machine/time_line.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/phase_names.hpp"
#include "emulator/torus/figures.hpp"
#include "firmware/protocol/hints.hpp"

namespace torolux {

class MachineWatcher;  // emulator/trace/watcher.hpp
class RecordWatcher;   // emulator/trace/record_watcher.hpp
class Pacer;           // emulator/trace/pacer.hpp
class HopWatcher;      // emulator/torus/hop_watcher.hpp
class SnapshotKeeper;  // emulator/snapshot/keeper.hpp
class SnapshotReader;  // emulator/snapshot/archive.hpp
class PesElsewhere;    // emulator/machine/pes_elsewhere.hpp
struct TurnLog;        // emulator/engines/engine/turn_log.hpp
namespace profile {
class CycleProfile;  // emulator/profile/cycle_profile.hpp
}

struct MachineSetup {
  MachineDescription description;
  unsigned columns = 4;
  unsigned rows = 4;
  std::uint32_t local_memory_bytes = protocol::kDefaultLocalMemory;
  std::string engine = kDefaultEngine;
  Debugging debugging;
  std::vector<std::string> arguments;  ///< of the program's main, from argv[1] on
  unsigned threads = 0;                ///< 0: all cores
  Cycles until = 0;  ///< the run ends at this virtual time, if it has not ended before (docs/virtual_time.md); 0: never
  std::uint32_t frame_width = 0;
  std::uint32_t frame_height = 0;
  double progress_seconds = 0.1;      ///< from one call of `progress` to the next [s of wall time], about
  std::uint32_t frame_layers = 0;     ///< planes of the frame buffer besides the colours, as bits (protocol::plane_bit)
  MachineWatcher* watcher = nullptr;  ///< told what happens; outlives the machine. Changes nothing of the run
  RecordWatcher* record_watcher = nullptr;  ///< shown what packets and messages hold; likewise
  Pacer* pacer = nullptr;                   ///< holds it back, so that somebody can follow; likewise
  HopWatcher* hop_watcher = nullptr;        ///< told of each hop of packets; likewise
  SnapshotKeeper* keeper = nullptr;         ///< given the machine's state whenever it wants that; likewise
  profile::CycleProfile* profile =
      nullptr;                             ///< told of each instruction; likewise. With the engine `interpreted` alone
  PesElsewhere* ranks = nullptr;           ///< these run the PEs; likewise. Null: this process does
  TurnLog* turns = nullptr;                ///< filled in by an engine of this process with one thread; likewise
  std::function<bool()> interrupted = {};  ///< asked while engines get ready (EngineSetup); null: never
};

struct PeFigures {
  Cycles begin = 0;        ///< 0, or that of the stage
  Cycles cycles = 0;       ///< its length: busy + waits + idle at the end
  Cycles busy_cycles = 0;  ///< executing instructions
  WaitCycles waits{};      ///< waiting in HINTs, by WaitReason
  Cycles idle_at_end = 0;  ///< from the last thing that it did to the end of the run
  bool halted = false;     ///< its program has ended
  std::uint64_t instructions = 0;
  std::uint64_t packets_sent = 0;       ///< to the torus
  std::uint64_t packets_delivered = 0;  ///< from the torus, diverted ones too
  std::uint64_t records_diverted = 0;
  std::uint32_t record_slots_high_water = 0;
  Cycles copy_out_cycles = 0;                            ///< of its NIU's outgoing copy engine
  Cycles copy_in_cycles = 0;                             ///< and of the incoming one
  std::uint32_t receive_buffers_high_water = 0;          ///< packets from the torus
  std::array<Cycles, protocol::kPhases> phase_cycles{};  ///< busy, by innermost phase

  Cycles idle_cycles() const;     ///< all that it is not busy
  Cycles outside_phases() const;  ///< busy, but in no phase
};

struct HostFigures {
  Cycles busy_cycles = 0;                              ///< of `now`, in cycles of the PEs
  std::array<std::uint64_t, kHostWorks> items{};       ///< by HostWork
  std::array<std::uint64_t, kHostWorks> own_cycles{};  ///< likewise, of the host's processor
};

/// Of one kind of records on the torus.
struct KindFigures {
  std::string name;
  std::uint64_t packets = 0;  ///< that carry at least one
  std::uint64_t records = 0;
  std::uint64_t bytes = 0;  ///< of the records

  template <class Archive>
  void archive(Archive& archive) {
    archive(name, packets, records, bytes);
  }
};

struct StageFigures;

/// Of a run, or of one stage of it.
struct MachineFigures {
  Cycles now = 0;                              ///< virtual time at which nothing happens any more: event, PE or host
  bool stopped = false;                        ///< at MachineSetup::until; there would have been more
  std::uint64_t trace_hash = 0;                ///< of the sequence of all events: equal runs have equal ones
  PhaseNames phases = built_in_phase_names();  ///< the images', and those that they have no name for but use
  std::vector<PeFigures> pes;
  std::vector<RouterFigures> routers;  ///< of each PE
  PacketFigures packets;               ///< that have left the torus
  std::uint64_t link_retries = 0;
  std::vector<KindFigures> record_kinds;  ///< as the host program has them; empty: it has none
  BusFigures bus;
  HostFigures host;
  Cycles frame_buffer_busy_cycles = 0;
  std::uint32_t frame_buffer_high_water = 0;  ///< messages in its queue
  Cycles frame_buffer_message_cycles = 0;     ///< summed over messages: in the queue or being added
  std::uint64_t pixels_added = 0;
  double scheduler_seconds = 0;      ///< host CPU time that the emulator itself used
  double program_seconds = 0;        ///< of it, of the host's program
  double engine_seconds = 0;         ///< host CPU time of the engine (all its processes or threads)
  TimeLineFigures time_line;         ///< of a run
  std::vector<StageFigures> stages;  ///< of a run: stages of the host's program, one behind the other

  std::uint64_t instructions() const;  ///< of all PEs
  /// What the network's side has counted.
  template <class Archive>
  void archive(Archive& archive) {
    archive(now, pes, routers, packets, link_retries, record_kinds, bus, host, frame_buffer_busy_cycles,
            frame_buffer_high_water, frame_buffer_message_cycles, pixels_added);
  }
};

/// The network's side, the host too, is in a stage from when the host begins it until it begins the next one; a PE,
/// from its first arrival of the stage on. So lengths, and all counts, add up to those of the run on either side.
struct StageFigures {
  std::string name;
  Cycles begin = 0;        ///< by the host's clock
  MachineFigures figures;  ///< of the stage alone, `now` its length; high-water marks: of the run up to its end
};

class Machine {
 public:
  /// Loads each PE's image: an Image, where all have the same. Throws InputError, MachineFailure.
  Machine(const MachineSetup& setup, ImageSet images);
  ~Machine();

  /// Runs until the program has finished and the machine is empty. Again, if the last time it was to stay: then virtual
  /// time goes on where it had ended, the PEs are where they were, and the program has the same kinds of records.
  /// progress: called every setup.progress_seconds, about, from the calling thread; returning false ends the run.
  /// Throws MachineFailure: trap, dead or silent PE, deadlock (with what each actor waits for), fault of the program;
  /// the calls that led there are in the lines behind the first. from: the state of an equal machine, from which this
  /// one goes on, and so does the program; null: none. Throws InputError where it is not one. With it, or with a
  /// keeper, the engine must be one that can be saved (UsageError).
  enum class Then : std::uint8_t { end, stay };
  void run(HostProgram& program, const std::function<bool(Cycles)>& progress = {}, Then then = Then::end,
           SnapshotReader* from = nullptr);
  /// Of a machine that has stayed: no more runs. The same figures as if it had not stayed.
  void end();
  /// Of a machine that has stayed: the frame buffer is that of an empty picture. layers: as in MachineSetup.
  void begin_picture(std::uint32_t width, std::uint32_t height, std::uint32_t layers);

  /// What can be known at once of a machine that runs; for `progress` alone. Waits for nobody and changes nothing.
  /// figures: overwritten; given again, nothing is allocated.
  void sample(LiveFigures& figures) const;
  const FrameBuffer& frame_buffer() const;
  const FrameChanges& frame_changes() const;
  /// For whoever looks on: its PE may be writing it.
  std::span<const std::byte> local_memory(unsigned pe) const;
  /// Where each PE stands, one line for all in the same place; of a machine that runs, for `progress` alone. Waits
  /// until those that run can be looked at.
  std::string where_pes_stand() const;
  /// Exact at a moment when nothing is in flight (between stages, at the end): a host program may ask in on_message.
  MachineFigures figures() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace torolux
