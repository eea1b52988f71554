// SPDX-License-Identifier: MIT
// Makes a matrix of a mesh's angles and applies it.
#include "host_tools/scene/mesh_transform.hpp"

#include "host_tools/scene/rotation.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

MeshTransform::MeshTransform(const MeshEntry& entry) : scale_(entry.scale), translate_(entry.translate) {
  for (std::size_t i = 0; i < 3; ++i) {
    Vec3d unit{0, 0, 0};
    unit[i] = 1;
    const Vec3d column = rotated(entry.rotate, unit);
    for (std::size_t row = 0; row < 3; ++row) rotate_[row][i] = column[row];
  }
}

Vec3d MeshTransform::direction(const Vec3d& d) const {
  return rotated(rotate_, {d[0] * scale_[0], d[1] * scale_[1], d[2] * scale_[2]});
}

Vec3d MeshTransform::position(const Vec3d& p) const {
  return vec::add(direction(p), translate_);
}

Vec3d MeshTransform::normal(const Vec3d& n) const {
  return rotated(rotate_, {n[0] / scale_[0], n[1] / scale_[1], n[2] / scale_[2]});
}

}  // namespace torolux
