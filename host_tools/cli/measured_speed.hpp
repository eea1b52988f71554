// SPDX-License-Identifier: MIT
// How fast this computer runs the machine. Enters: what a render took and what had been foretold of its work; leaves: a
// factor for the next prediction, kept in the user's cache.
#pragma once

#include <optional>
#include <string>

#include "host_tools/render/render.hpp"

namespace torolux {

/// How many times as long as wall_seconds_of says the last render of this engine took here; nothing where none has
/// been measured, or there is no cache.
std::optional<double> measured_slowness(const std::string& engine);

/// Remembers it, where the run took long enough to tell and all PEs were of this engine. Does nothing where there is no
/// cache.
void remember_speed(const MachineChoice& machine, const RenderFigures& figures);

}  // namespace torolux
