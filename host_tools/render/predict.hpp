// SPDX-License-Identifier: MIT
// What a render will take: mesh, placement and settings in; virtual time, records and instructions out, before anything
// runs. Rough: within a factor of two where light fills the scene as it does in a room.
#pragma once

#include <cstdint>

#include "host_tools/render/render.hpp"
#include "host_tools/setup/setup.hpp"

namespace torolux {

/// draft: the setup of draft_of(quality), where there is one. Throws InputError where there is no light.
Prediction predict(const Scene& scene, const Camera& camera, const RenderSetup& setup, const RenderSetup* draft,
                   const Quality& quality, const MachineChoice& machine);

/// What so many instructions of all PEs and packets take on a computer of 2020. pes: of the machine.
double wall_seconds_of(double instructions, double packets, const MachineChoice& machine, unsigned pes);

}  // namespace torolux
