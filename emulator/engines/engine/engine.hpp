// SPDX-License-Identifier: MIT
// What runs the PEs' processors. The scheduler does not know which engine it is: they meet in the NIU channels alone.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string_view>
#include <vector>

#include "emulator/description/description.hpp"
#include "emulator/engines/engine/pe_debugger.hpp"
#include "emulator/engines/engine/registers.hpp"
#include "emulator/engines/engine/shared_memory.hpp"
#include "emulator/engines/image/image_set.hpp"
#include "emulator/niu/waker.hpp"
#include "firmware/protocol/machine.hpp"

namespace torolux {

class SnapshotWriter;  // emulator/snapshot/archive.hpp
struct TurnLog;        // emulator/engines/engine/turn_log.hpp
namespace profile {
class CycleProfile;  // emulator/profile/cycle_profile.hpp
}

/// One PE as engine and emulator share it: local memory with the image loaded and the NIU window filled in.
struct PeMemory {
  SharedMemory channel;  ///< a NiuChannel
  SharedMemory local;    ///< local memory, from kLocalMemoryBase; may be mapped larger than the PE's size
  std::uint32_t local_memory_bytes;
};

/// Bytes to map as PeMemory::local for a PE with this much local memory: engines may need room behind it.
std::size_t mapped_bytes_for(std::uint32_t local_memory_bytes);

/// What it refers to must outlive the engine.
struct EngineSetup {
  const MachineDescription& machine;
  const ImageSet& images;
  std::vector<PeMemory>& pes;
  unsigned threads;                          ///< host threads to use, >= 1
  std::vector<bool> elsewhere = {};          ///< by number: PEs that another engine of this machine runs; empty: none
  profile::CycleProfile* profile = nullptr;  ///< filled in while the PEs run; null: none
  PeDebugger* debugger = nullptr;            ///< holds some of the PEs, where the engine can lend them; null: nobody
  TurnLog* turns = nullptr;                  ///< filled in, where one thread runs PEs of this process; null: none
  std::function<bool()> interrupted = {};    ///< asked while the engine gets ready, which may take a minute; then that
                                             ///< ends by a MachineFailure. Null: never

  bool holds(unsigned pe) const { return debugger != nullptr && debugger->holds(pe); }
  bool runs(std::size_t pe) const { return elsewhere.empty() || !elsewhere[pe]; }
};

class Engine {
 public:
  virtual ~Engine() = default;  ///< leaves no process, thread or file behind
  virtual std::string_view name() const = 0;
  /// Lets every PE begin at `_start`. Returns at once.
  virtual void start() = 0;
  /// Throws MachineFailure (PE, reason, log) if a PE can no longer go on. Cheap; called at least five times a second.
  /// PEs of this process need none: one that can never go on tells the network itself.
  virtual void check() {}
  /// Ends all PEs that still run. Called once, after the channels have been told to stop.
  virtual void stop() = 0;
  // ---- Saving and going on ----

  /// Whether those that follow can be called.
  virtual bool can_be_saved() const { return false; }
  /// From here to `let_go` no PE executes anything, even one that waits in a HINT and could go on; what all have said
  /// is in their channels. So `save` finds each as its channel says. Nothing, where PEs go nowhere while they wait.
  virtual void hold() {}
  virtual void let_go() {}
  /// Of a PE of another rank, held: writes its channel (niu/channel_archive.hpp). False: its
  /// channel is in this process.
  virtual bool save_channel(unsigned /*pe*/, SnapshotWriter& /*archive*/) { return false; }
  /// Before the start: `save` may be called.
  virtual void will_be_saved() {}
  /// Of a PE that waits in a HINT for the network's side, or has halted; it waits on.
  virtual PeRegisters save(unsigned /*pe*/) { return {}; }
  /// Before the start: the PE does not begin at `_start`, but where this says; its memory is as it was then.
  virtual void restore(unsigned /*pe*/, const PeRegisters& /*registers*/) {}

  // ---- Telling where a PE stands ----

  /// Of a PE that waits in a HINT, has failed, or has ended with a fault; of one that runs, as soon as that can be
  /// looked at. Nothing: this engine cannot tell. Waits no longer than some seconds.
  virtual std::optional<StackRegisters> stack_registers(unsigned /*pe*/) { return std::nullopt; }

  // ---- For engines whose PEs run on other ranks ----

  /// Of PEs that all wait: what they have counted is in their channels.
  virtual void bring_figures() {}
  /// As it stands, this part of its local memory is in PeMemory::local.
  virtual void bring(unsigned /*pe*/, std::uint32_t /*offset*/, std::uint32_t /*bytes*/) {}
  /// Host CPU time of the other ranks, as of the last bring_figures [s].
  virtual double seconds_elsewhere() const { return 0; }

  /// Host CPU time that the PEs have used so far [s]; 0 where the engine cannot tell it from the emulator's own.
  virtual double cpu_seconds() const { return 0; }

  // ---- For engines whose PEs run in this process; only the scheduler's thread calls these ----

  /// Who is told that this PE may go on; none: it sleeps on its channel.
  virtual ProcessorWaker* waker(unsigned /*pe*/) { return nullptr; }
  /// The scheduler has nothing to do until this PE's bound is later than `wanted`: runs that PE, or another, for some
  /// milliseconds at most. False: nothing to run here; sleep. Throws as check() does.
  virtual bool help(unsigned /*pe*/, std::uint64_t /*wanted*/) { return false; }
  /// This PE runs only when it is helped, and only as long as its clock is less than `wanted`, one instruction at
  /// least: so that PEs of a debugger run in the order of virtual time.
  virtual bool takes_turns(unsigned /*pe*/) const { return false; }
  /// This PE runs only when it is helped, and nobody gains if it could run before it has to.
  virtual bool runs_only_helped(unsigned /*pe*/) const { return false; }
  /// This PE will probably be the next to be helped: what that needs, fetched into the caches meanwhile.
  virtual void fetch_ahead(unsigned /*pe*/) const {}
  /// Time spent in `help` so far [s].
  virtual double help_seconds() const { return 0; }
};

inline constexpr const char* kQemuEngine = "qemu";  ///< the reference

}  // namespace torolux
