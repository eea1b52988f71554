// SPDX-License-Identifier: MIT
// Rotations about the axes.
#include "host_tools/scene/rotation.hpp"

#include <cmath>
#include <numbers>

#include "host_tools/scene/vec.hpp"

namespace torolux {

RotationRows rotation(std::size_t axis, double degrees) {
  const double turns = degrees / 90.0;
  double sine = std::sin(degrees * std::numbers::pi / 180.0);
  double cosine = std::cos(degrees * std::numbers::pi / 180.0);
  if (turns == std::round(turns)) {
    sine = std::round(sine);
    cosine = std::round(cosine);
  }
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  RotationRows rows{};
  rows[axis][axis] = 1;
  rows[u][u] = cosine;
  rows[u][v] = -sine;
  rows[v][u] = sine;
  rows[v][v] = cosine;
  return rows;
}

Vec3d rotated(const RotationRows& rows, const Vec3d& v) {
  return {vec::dot(rows[0], v), vec::dot(rows[1], v), vec::dot(rows[2], v)};
}

Vec3d rotated(const Vec3d& degrees, const Vec3d& v) {
  return rotated(rotation(2, degrees[2]), rotated(rotation(1, degrees[1]), rotated(rotation(0, degrees[0]), v)));
}

}  // namespace torolux
