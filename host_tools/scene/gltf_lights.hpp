// SPDX-License-Identifier: MIT
// Lights of a glTF file (KHR_lights_punctual) and where they are in; small emitting bodies out.
#pragma once

#include <span>

#include "host_tools/scene/affine.hpp"
#include "host_tools/scene/gltf_object.hpp"
#include "host_tools/scene/gltf_units.hpp"
#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

struct GltfLight {
  std::size_t number;  ///< into the file's lights
  Affine place;
};

/// size: half the width of the bodies, scene units; less where lights are nearer to each other, or several at one
/// place. Adds triangles, their materials and parts to `mesh`. A point has the intensity that is told in all
/// directions, on average; a spot on its axis. Those at one place add up: discs of spots hide nothing of each other and
/// little of a point (docs/gltf.md). Throws InputError: an unknown type, a value out of range.
void add_gltf_lights(const GltfObject& root, std::span<const GltfLight> lights, double size, GltfUnits units,
                     ImportedMesh& mesh, Notices& notices);

}  // namespace torolux
