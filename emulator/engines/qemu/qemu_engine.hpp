// SPDX-License-Identifier: MIT
// The reference engine: one qemu-system-riscv32 for each PE, with our plugin in it.
#pragma once

#include <memory>
#include <vector>

#include "emulator/engines/engine.hpp"
#include "emulator/engines/qemu/plugin_share.hpp"

namespace torolux {

/// Logs of what HINTs do, one for each PE, for `torolux bench engine`: see hint_log.hpp.
struct QemuHintLogs {
  HintLogUse use;
  std::vector<SharedMemory>& logs;  ///< must outlive the engine
};

/// QEMU and the plugin are looked for when the PEs are started. setup.pes must outlive the engine.
std::unique_ptr<Engine> make_qemu_engine(const EngineSetup& setup);
std::unique_ptr<Engine> make_qemu_engine(const EngineSetup& setup, const QemuHintLogs& logs);

}  // namespace torolux
