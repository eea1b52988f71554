// SPDX-License-Identifier: MIT
// A polygon with any number of corners in, triangles with the same winding out.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "host_tools/scene/scene.hpp"

namespace torolux {

struct PolygonTriangles {
  std::vector<std::array<std::uint32_t, 3>> triangles;  ///< corner numbers of the polygon
  bool crosses_itself = false;                          ///< cut up as well as could be
};

/// The two axes that a polygon's normal (Newell's) leans away from least, in the order in which its corners run
/// counter-clockwise; absent: it has no area.
std::optional<std::array<std::size_t, 2>> plane_axes(std::span<const Vec3d> corners);

/// Ear clipping in the plane of plane_axes; concave
/// polygons and corners on straight edges are kept as they are. Of the possible ears the roundest is cut first.
/// Fewer than three corners, or no area: no triangles.
PolygonTriangles cut_polygon(std::span<const Vec3d> corners);

}  // namespace torolux
