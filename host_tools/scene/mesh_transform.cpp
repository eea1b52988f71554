// SPDX-License-Identifier: MIT
// Makes a matrix of a mesh's angles and applies it.
#include "host_tools/scene/mesh_transform.hpp"

#include <cmath>
#include <numbers>

namespace torolux {
namespace {

using Matrix = std::array<Vec3d, 3>;  // rows

Vec3d times(const Matrix& m, const Vec3d& v) {
  return {vec::dot(m[0], v), vec::dot(m[1], v), vec::dot(m[2], v)};
}

/// Rotation about one axis; multiples of 90 degrees are exact.
Matrix rotation(std::size_t axis, double degrees) {
  const double turns = degrees / 90.0;
  double sine = std::sin(degrees * std::numbers::pi / 180.0);
  double cosine = std::cos(degrees * std::numbers::pi / 180.0);
  if (turns == std::round(turns)) {
    sine = std::round(sine);
    cosine = std::round(cosine);
  }
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  Matrix m{};
  m[axis][axis] = 1;
  m[u][u] = cosine;
  m[u][v] = -sine;
  m[v][u] = sine;
  m[v][v] = cosine;
  return m;
}

}  // namespace

MeshTransform::MeshTransform(const MeshEntry& entry) : scale_(entry.scale), translate_(entry.translate) {
  const Matrix x = rotation(0, entry.rotate[0]);
  const Matrix y = rotation(1, entry.rotate[1]);
  const Matrix z = rotation(2, entry.rotate[2]);
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3d unit{0, 0, 0};
    unit[i] = 1;
    const Vec3d column = times(z, times(y, times(x, unit)));
    for (std::size_t row = 0; row < 3; ++row) rotate_[row][i] = column[row];
  }
}

Vec3d MeshTransform::direction(const Vec3d& d) const {
  return times(rotate_, {d[0] * scale_[0], d[1] * scale_[1], d[2] * scale_[2]});
}

Vec3d MeshTransform::position(const Vec3d& p) const {
  return vec::add(direction(p), translate_);
}

Vec3d MeshTransform::normal(const Vec3d& n) const {
  return times(rotate_, {n[0] / scale_[0], n[1] / scale_[1], n[2] / scale_[2]});
}

}  // namespace torolux
