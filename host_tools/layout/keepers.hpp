// SPDX-License-Identifier: MIT
// Who keeps the surfaces (lattice and the trees to it) of common polygons that do not stand on every PE: heat and bytes
// enter; leaves: the keepers, work and memory even. No picture depends on it.
#pragma once

#include <cstdint>

#include "host_tools/layout/placement.hpp"

namespace torolux {

/// part: of Mesh::parts, its triangle has sides.
SurfaceSize surface_size(const Mesh& mesh, std::uint32_t part);

/// placement: cells and polygons are placed. load: common_surface is given.
void keep_surfaces(const Mesh& mesh, const StageLoad& load, Placement& placement);

}  // namespace torolux
