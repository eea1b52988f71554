// SPDX-License-Identifier: MIT
// A polygon with any number of corners in, triangles with the same winding out.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/scene/scene.hpp"

namespace torolux {

struct PolygonTriangles {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< corner numbers of the polygon
  bool crosses_itself = false;                          ///< cut up as well as could be
};

/// Ear clipping in the plane of the two axes that the polygon's normal (Newell's) leans away from least; concave
/// polygons and corners on straight edges are kept as they are. Of the possible ears the roundest is cut first.
/// Fewer than three corners, or no area: no triangles.
PolygonTriangles cut_polygon(std::span<const Vec3d> corners);

}  // namespace torolux
