// SPDX-License-Identifier: MIT
// Separating axes: the box's three, the triangle's normal, and the products of their edges; in double, with slack for
// rounding.
#include "host_tools/subspace/overlap.hpp"

#include <algorithm>
#include <array>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Triangle corners relative to the box's centre, and its half edges.
struct Placed {
  std::array<Vec3d, 3> corner;
  Vec3d half;
};

bool separated(const Placed& placed, const Vec3d& axis) {
  const double a = vec::dot(placed.corner[0], axis);
  const double b = vec::dot(placed.corner[1], axis);
  const double c = vec::dot(placed.corner[2], axis);
  const double reach =
      placed.half[0] * std::abs(axis[0]) + placed.half[1] * std::abs(axis[1]) + placed.half[2] * std::abs(axis[2]);
  const double slack = 1e-12 * (std::abs(axis[0]) + std::abs(axis[1]) + std::abs(axis[2]));
  return std::min({a, b, c}) > reach + slack || std::max({a, b, c}) < -reach - slack;
}

}  // namespace

bool touches_box(std::span<const Vec3d, 3> corner, const Vec3d& low, const Vec3d& high, double margin) {
  const Vec3d centre = vec::scale(vec::add(low, high), 0.5);
  Placed placed{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    placed.corner[axis] = vec::subtract(corner[axis], centre);
    placed.half[axis] = 0.5 * (high[axis] - low[axis]) + margin;
  }
  const std::array<Vec3d, 3> edge{vec::subtract(corner[1], corner[0]), vec::subtract(corner[2], corner[1]),
                                  vec::subtract(corner[0], corner[2])};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3d unit_axis{0, 0, 0};
    unit_axis[axis] = 1;
    if (separated(placed, unit_axis)) return false;
  }
  if (separated(placed, vec::cross(edge[0], edge[1]))) return false;
  for (const Vec3d& e : edge) {
    const std::array<Vec3d, 3> axes{Vec3d{0, -e[2], e[1]}, Vec3d{e[2], 0, -e[0]}, Vec3d{-e[1], e[0], 0}};
    for (const Vec3d& axis : axes) {
      if (separated(placed, axis)) return false;
    }
  }
  return true;
}

}  // namespace torolux
