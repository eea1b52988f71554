// SPDX-License-Identifier: MIT
// The few operations on three doubles that the host needs.
#pragma once

#include <algorithm>
#include <cmath>

#include "host_tools/scene/scene.hpp"

namespace torolux::vec {

inline Vec3d add(const Vec3d& a, const Vec3d& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3d subtract(const Vec3d& a, const Vec3d& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3d scale(const Vec3d& a, double s) {
  return {a[0] * s, a[1] * s, a[2] * s};
}
/// Channel by channel.
inline Vec3d times(const Vec3d& a, const Vec3d& b) {
  return {a[0] * b[0], a[1] * b[1], a[2] * b[2]};
}
inline double dot(const Vec3d& a, const Vec3d& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double sum(const Vec3d& a) {
  return a[0] + a[1] + a[2];
}
inline double length(const Vec3d& a) {
  return std::hypot(a[0], a[1], a[2]);
}
/// Length 1; a must not be zero.
inline Vec3d unit(const Vec3d& a) {
  return scale(a, 1.0 / length(a));
}
inline double largest(const Vec3d& a) {
  return std::max({a[0], a[1], a[2]});
}

/// Of a triangle seen from a point, in steradians; seen from behind it is negative (Van Oosterom & Strackee 1983, "The
/// solid angle of a plane triangle").
inline double solid_angle(const std::array<Vec3d, 3>& corner, const Vec3d& point) {
  const Vec3d a = subtract(corner[0], point);
  const Vec3d b = subtract(corner[1], point);
  const Vec3d c = subtract(corner[2], point);
  const double la = length(a);
  const double lb = length(b);
  const double lc = length(c);
  return 2 * std::atan2(dot(a, cross(b, c)), la * lb * lc + dot(a, b) * lc + dot(b, c) * la + dot(c, a) * lb);
}

/// Axis-parallel box around points.
struct Box {
  Vec3d low{HUGE_VAL, HUGE_VAL, HUGE_VAL};
  Vec3d high{-HUGE_VAL, -HUGE_VAL, -HUGE_VAL};

  void include(const Vec3d& p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], p[axis]);
      high[axis] = std::max(high[axis], p[axis]);
    }
  }
  Vec3d extent() const { return subtract(high, low); }
  Vec3d centre() const { return scale(add(low, high), 0.5); }
};

}  // namespace torolux::vec
