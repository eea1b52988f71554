// SPDX-License-Identifier: MIT
// A ray enters; the nearest triangle of a scene on its way leaves. A pass over all triangles: for a few rays.
#pragma once

#include <cstdint>
#include <optional>

#include "host_tools/scene/scene.hpp"

namespace torolux {

struct SceneHit {
  std::uint32_t triangle;
  double distance;  ///< in lengths of the direction
  bool front;       ///< the side that is met
};

inline constexpr std::uint32_t kNoTriangle = 0xFFFF'FFFFU;

/// Absent: nothing is met. without: a triangle that is passed through, that on which the ray begins.
std::optional<SceneHit> cast_ray(const Scene& scene, const Vec3d& origin, const Vec3d& direction,
                                 std::uint32_t without = kNoTriangle);

/// Unit normal of a triangle's front.
Vec3d front_normal(const Scene& scene, std::uint32_t triangle);

}  // namespace torolux
