// SPDX-License-Identifier: MIT
// The reference engine: one qemu-system-riscv32 for each PE, with our plugin in it.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "emulator/engines/engine/debugging.hpp"
#include "emulator/engines/engine/engine.hpp"
#include "emulator/engines/qemu/plugin_share.hpp"

namespace torolux {

/// Logs of what HINTs do, one for each PE, for `torolux bench engine`: see hint_log.hpp.
struct QemuHintLogs {
  HintLogUse use;
  std::vector<SharedMemory>& logs;  ///< must outlive the engine
};

struct QemuOptions {
  std::optional<QemuHintLogs> logs = {};
  /// Memory of a HintMeeting for each PE: whoever has it does what HINTs do. nullptr: QEMU's plugin does.
  std::vector<SharedMemory>* meetings = nullptr;
  std::vector<GdbEndpoint> gdb = {};                     ///< of PEs that this engine runs
  std::function<void(const GdbEndpoint&)> listens = {};  ///< as Debugging::listens
};

/// QEMU and the plugin are looked for when the PEs are started. setup.pes must outlive the engine. Throws InputError
/// where a debugger's port is in use.
std::unique_ptr<Engine> make_qemu_engine(const EngineSetup& setup, const QemuOptions& options = {});
std::unique_ptr<Engine> make_qemu_engine(const EngineSetup& setup, const QemuHintLogs& logs);

}  // namespace torolux
