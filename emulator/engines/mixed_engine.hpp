// SPDX-License-Identifier: MIT
// Two engines in one machine: the named PEs on QEMU, all others on the engine that the user chose. Enters: the choice;
// leaves: an engine like any other.
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "emulator/engines/engine/debugging.hpp"
#include "emulator/engines/engine_names.hpp"

namespace torolux {

/// The engine of this name, but for what `debugging` wants on QEMU. Throws as engine_named and Debugging::on_qemu, and
/// InputError for a port that is in use. setup.elsewhere: empty.
std::unique_ptr<Engine> make_engine(std::string_view name, const EngineSetup& setup, const Debugging& debugging);

}  // namespace torolux
