// SPDX-License-Identifier: MIT
// The reference engine: one qemu-system-riscv32 for each PE, with our plugin in it.
#pragma once

#include <memory>

#include "emulator/engines/engine.hpp"

namespace torolux {

/// QEMU and the plugin are looked for when the PEs are started. setup.pes must outlive the engine.
std::unique_ptr<Engine> make_qemu_engine(const EngineSetup& setup);

}  // namespace torolux
