// SPDX-License-Identifier: MIT
// A ray and a triangle enter; where the ray meets the triangle's plane leaves.
#pragma once

#include <array>
#include <optional>

#include "host_tools/scene/vec.hpp"

namespace torolux {

/// origin + t direction = corner 0 + b1 (corner 1 - corner 0) + b2 (corner 2 - corner 0).
struct PlaneHit {
  double t, b1, b2;
  double determinant;  ///< above 0: the front is met

  bool inside() const { return b1 >= 0 && b2 >= 0 && b1 + b2 <= 1; }
};

/// Moeller & Trumbore 1997, "Fast, minimum storage ray/triangle intersection". Absent: the ray is parallel to the
/// plane, or the triangle has no area.
inline std::optional<PlaneHit> meet_plane(const Vec3d& origin, const Vec3d& direction,
                                          const std::array<Vec3d, 3>& corner) {
  const Vec3d first = vec::subtract(corner[1], corner[0]);
  const Vec3d second = vec::subtract(corner[2], corner[0]);
  const Vec3d across = vec::cross(direction, second);
  const double determinant = vec::dot(first, across);
  if (determinant == 0) return std::nullopt;
  const Vec3d from = vec::subtract(origin, corner[0]);
  const Vec3d turned = vec::cross(from, first);
  return PlaneHit{vec::dot(second, turned) / determinant, vec::dot(from, across) / determinant,
                  vec::dot(direction, turned) / determinant, determinant};
}

}  // namespace torolux
