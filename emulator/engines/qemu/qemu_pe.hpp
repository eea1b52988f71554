// SPDX-License-Identifier: MIT
// One PE on QEMU: its process, what it shares with the plugin in there, and whether it still gets on.
#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "emulator/engines/engine/gdb_socket.hpp"
#include "emulator/engines/qemu/gdb_connection.hpp"
#include "emulator/engines/qemu/gdb_registers.hpp"
#include "emulator/engines/qemu/plugin_share.hpp"
#include "emulator/engines/qemu/qemu_engine.hpp"
#include "emulator/engines/qemu/qemu_process.hpp"
#include "emulator/niu/channel.hpp"
#include "emulator/niu/ending.hpp"

namespace torolux {

/// What is the same for all PEs of an engine.
struct QemuLaunch {
  EngineSetup setup;
  std::optional<QemuHintLogs> logs;
  std::vector<SharedMemory>* meetings;
  std::string plugin;  // as QEMU's option takes it
  std::vector<int> cores;
  bool to_be_saved = false;
  std::vector<std::optional<PeRegisters>> restored;  // by PE; empty: all begin
};

class QemuPe {
 public:
  /// Starts the process. debugger: where one may connect; nullptr: not at all.
  QemuPe(std::size_t number, const QemuLaunch& launch, const GdbSocket* debugger);

  std::size_t number() const { return number_; }
  /// Throws MachineFailure where the PE cannot go on. tick: wall time since the last look.
  void check(std::uint64_t most_cycles_between_hints, std::chrono::steady_clock::duration tick);
  /// It waits in a HINT, or has halted.
  PeRegisters save();
  /// As Engine::stack_registers. Waits so long for the PE to tell them.
  std::optional<StackRegisters> stack_registers(std::chrono::steady_clock::duration longest);
  void kill() { process_.kill(); }
  double cpu_seconds() const { return process_.cpu_seconds(); }  ///< of the host's time

 private:
  void end(std::uint64_t clock, const NiuFault& fault);
  void watch_progress(std::uint64_t cycles, std::chrono::steady_clock::duration tick);
  [[noreturn]] void fail(const std::string& what) const;
  static PluginShare& prepare(SharedMemory& memory, std::size_t number, const QemuLaunch& launch, bool debugged);
  static QemuProcess start(std::size_t number, const QemuLaunch& launch, const SharedMemory& share,
                           const GdbSocket* debugger, const GdbConnection* line);
  void let_begin(const std::optional<PeRegisters>& registers);

  std::size_t number_;
  std::span<const std::byte> memory_;
  NiuChannel& channel_;
  bool debugged_;
  bool ended_ = false;  // by us
  struct Ending {
    std::uint64_t clock;
    NiuFault fault;
  };
  std::optional<Ending> ending_;  // of which the network does not know yet
  SharedMemory share_memory_;
  PluginShare& share_;
  std::optional<GdbConnection> line_;  // where it is to be saved, or goes on
  QemuProcess process_;
  std::uint64_t last_cycles_ = 0;
  std::uint64_t last_hints_ = 0;
  std::chrono::steady_clock::duration silence_{};
  double cpu_seconds_before_silence_ = 0;
};

}  // namespace torolux
