// SPDX-License-Identifier: MIT
// Primitives of a glTF mesh in; triangles in the mesh's own space out.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/scene/gltf_data.hpp"
#include "host_tools/scene/gltf_textures.hpp"

namespace torolux {

/// One primitive.
struct GltfSurface {
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;  ///< for the first positions, or none; NaN where they are not finite
  std::vector<std::array<double, 2>> texture_points;    ///< likewise, u rightwards, v upwards
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< corners counter-clockwise seen from the front
};

/// mapping: of its material. No triangles: points and lines, or no positions; told.
/// Throws InputError: a corner that names no vertex, a position that is used and not finite or above 1e15.
GltfSurface read_gltf_surface(const GltfObject& primitive, std::size_t accessors, const GltfMapping& mapping,
                              GltfData& data, Notices& notices);

}  // namespace torolux
