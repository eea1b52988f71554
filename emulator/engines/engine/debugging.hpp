// SPDX-License-Identifier: MIT
// What a user wants to look at more closely: PEs that run on QEMU in a machine of another engine, and debuggers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <vector>

namespace torolux {

/// Where a debugger may connect.
struct GdbEndpoint {
  unsigned pe;                      ///< that it then holds: on QEMU, halted before its first instruction
  std::uint16_t port;               ///< TCP, on 127.0.0.1; 0: any that is free
  std::filesystem::path path = {};  ///< if not empty, a Unix socket there instead, for this user alone

  bool operator==(const GdbEndpoint&) const = default;
};

class PeDebugger;  // emulator/engines/engine/pe_debugger.hpp

struct Debugging {
  std::vector<unsigned> qemu_pes;  ///< these run on QEMU, whatever engine runs the rest
  std::vector<GdbEndpoint> gdb;    ///< these, too
  /// Called when a PE of `gdb` listens, with the port it has got.
  std::function<void(const GdbEndpoint&)> listens = {};

  /// The emulator's own debugger listens there, and holds the PEs that follow; pe: not looked at.
  std::optional<GdbEndpoint> own = {};
  std::vector<unsigned> own_pes = {};  ///< none: all that do not run on QEMU
  PeDebugger* debugger = nullptr;      ///< holds PEs of an engine of this process; outlives the machine; null: nobody

  /// By number of the PE: whether it runs on QEMU. Throws UsageError where one is named that is not in the machine, or
  /// twice for a debugger.
  std::vector<bool> on_qemu(std::size_t pes) const;
};

}  // namespace torolux
