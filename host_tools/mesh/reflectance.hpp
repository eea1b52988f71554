// SPDX-License-Identifier: MIT
// Scene and mesh enter; the diffuse reflectance of every patch leaves: the material's, times its texture's mean over
// the patch.
#pragma once

#include "host_tools/mesh/mesh.hpp"

namespace torolux {

/// Fills MeshPatch::reflectance from the rest of the mesh.
void set_reflectances(const Scene& scene, Mesh& mesh);

}  // namespace torolux
