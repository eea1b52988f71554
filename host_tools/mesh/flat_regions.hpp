// SPDX-License-Identifier: MIT
// A scene's triangles enter; leave: the flat regions that they form, whatever way each is cut into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Triangles of one material that hang together in one plane, wound alike, over edges that nothing else shares, and on
/// which texture points are one linear map.
struct FlatRegion {
  std::vector<std::uint32_t> triangles;  ///< ascending
  std::uint32_t seed;                    ///< the largest of them: its plane and texture points are the region's
};

struct FlatRegions {
  std::vector<FlatRegion> all;           ///< by their first triangles
  std::vector<std::uint32_t> region_of;  ///< by triangle
};

/// What lies within a millionth of the scene's size lies in a plane.
FlatRegions flat_regions(const Scene& scene);

/// Whether its normals, where it has any, are those of its plane. No triangle without area is plain.
bool is_plain(const Scene& scene, const SceneTriangle& triangle);

/// Whether a plain triangle goes on where another ends: of its material, in its plane, wound alike, its texture points
/// the same linear map but for whole periods. size: the scene's longest edge.
bool continues(const Scene& scene, const SceneTriangle& triangle, const SceneTriangle& other, double size);

/// The triangle of these corners (positions in its plane), with its texture points, moved by whole periods so that they
/// are small, and without normals. Adds texture points to the scene.
SceneTriangle part_of(Scene& scene, const SceneTriangle& triangle, const std::array<std::uint32_t, 3>& corners);

/// Texture point, or normal, at a place in a triangle's plane, from those of its corners.
template <typename Value>
Value interpolated(const std::array<double, 3>& weight, const std::array<Value, 3>& corner) {
  Value value{};
  for (std::size_t i = 0; i < value.size(); ++i)
    value[i] = weight[0] * corner[0][i] + weight[1] * corner[1][i] + weight[2] * corner[2][i];
  return value;
}

/// Weights of a triangle's corners at a point of its plane, inside or outside of it.
std::array<double, 3> weights_at(const Scene& scene, const SceneTriangle& triangle, const Vec3d& point);

}  // namespace torolux
