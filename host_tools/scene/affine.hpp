// SPDX-License-Identifier: MIT
// A linear map and a shift of points in space: how parts of a scene are placed.
#pragma once

#include <array>

#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

struct Affine {
  std::array<Vec3d, 3> axes{Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, 1}};  ///< where x, y and z come to lie
  Vec3d origin{0, 0, 0};

  Vec3d direction(const Vec3d& d) const {
    return vec::add(vec::scale(axes[0], d[0]), vec::add(vec::scale(axes[1], d[1]), vec::scale(axes[2], d[2])));
  }
  Vec3d point(const Vec3d& p) const { return vec::add(direction(p), origin); }
  /// Below 0: it mirrors.
  double determinant() const { return vec::dot(axes[0], vec::cross(axes[1], axes[2])); }
  /// By the inverse transpose, any length: that times the determinant is made of cross products.
  Vec3d normal(const Vec3d& n) const {
    const Vec3d turned = vec::add(
        vec::scale(vec::cross(axes[1], axes[2]), n[0]),
        vec::add(vec::scale(vec::cross(axes[2], axes[0]), n[1]), vec::scale(vec::cross(axes[0], axes[1]), n[2])));
    return determinant() < 0 ? vec::scale(turned, -1) : turned;
  }
  /// First `inner`, then this.
  Affine after(const Affine& inner) const {
    return {{direction(inner.axes[0]), direction(inner.axes[1]), direction(inner.axes[2])}, point(inner.origin)};
  }
};

}  // namespace torolux
