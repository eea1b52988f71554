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
