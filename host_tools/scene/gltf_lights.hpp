// SPDX-License-Identifier: MIT
// Lights of a glTF file (KHR_lights_punctual) and where they are in; small emitting bodies out.
#pragma once

#include "host_tools/scene/affine.hpp"
#include "host_tools/scene/gltf_object.hpp"
#include "host_tools/scene/gltf_units.hpp"
#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

struct GltfLight {
  std::size_t number;  ///< into the file's lights
  Affine place;
};

/// size: half the width of the bodies, scene units. Adds triangles, their materials and parts to `mesh`. A point has
/// the intensity that is told in all directions, on average; a spot on its axis. Throws InputError: an unknown type, a
/// value out of range.
void add_gltf_light(const GltfObject& root, const GltfLight& light, double size, GltfUnits units, ImportedMesh& mesh,
                    Notices& notices);

}  // namespace torolux
