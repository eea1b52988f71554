// SPDX-License-Identifier: MIT
// Who keeps the surfaces (irradiance and the trees to it) that do not stand wherever their polygons do: heat and bytes
// enter; leaves: for each one PE of those that have its polygon, work and memory as even as that allows. No picture
// depends on it.
#pragma once

#include "host_tools/layout/placement.hpp"

namespace torolux {

/// placement: cells and polygons are placed. load: common_surface is given.
void keep_surfaces(const Mesh& mesh, const StageLoad& load, Placement& placement);

}  // namespace torolux
