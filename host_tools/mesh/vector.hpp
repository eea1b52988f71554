// SPDX-License-Identifier: MIT
// Arithmetic on Vec3d, for the host's geometry.
#pragma once

#include <cmath>

#include "host_tools/scene/scene.hpp"

namespace torolux {

inline Vec3d add(const Vec3d& a, const Vec3d& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
inline Vec3d subtract(const Vec3d& a, const Vec3d& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline Vec3d scale(const Vec3d& a, double factor) {
  return {a[0] * factor, a[1] * factor, a[2] * factor};
}
inline double dot(const Vec3d& a, const Vec3d& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Vec3d cross(const Vec3d& a, const Vec3d& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double length(const Vec3d& a) {
  return std::sqrt(dot(a, a));
}
/// a must not be zero.
inline Vec3d unit(const Vec3d& a) {
  return scale(a, 1.0 / length(a));
}

}  // namespace torolux
