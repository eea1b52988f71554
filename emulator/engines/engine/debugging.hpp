// SPDX-License-Identifier: MIT
// What a user wants to look at more closely: PEs that run on QEMU in a machine of another engine, and debuggers.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <vector>

namespace torolux {

/// A debugger may hold this PE: it runs on QEMU, and is halted before its first instruction.
struct GdbEndpoint {
  unsigned pe;
  std::uint16_t port;               ///< TCP, on 127.0.0.1; 0: any that is free
  std::filesystem::path path = {};  ///< if not empty, a Unix socket there instead, for this user alone

  bool operator==(const GdbEndpoint&) const = default;
};

struct Debugging {
  std::vector<unsigned> qemu_pes;  ///< these run on QEMU, whatever engine runs the rest
  std::vector<GdbEndpoint> gdb;    ///< these, too
  /// Called when a PE of `gdb` listens, with the port it has got.
  std::function<void(const GdbEndpoint&)> listens = {};

  /// By number of the PE: whether it runs on QEMU. Throws UsageError where one is named that is not in the machine, or
  /// twice for a debugger.
  std::vector<bool> on_qemu(std::size_t pes) const;
};

}  // namespace torolux
