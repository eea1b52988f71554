// SPDX-License-Identifier: MIT
// How a [[mesh]] is placed: scaled, rotated about x, y and z, moved.
#pragma once

#include <array>

#include "host_tools/scene/scene_file.hpp"

namespace torolux {

class MeshTransform {
 public:
  explicit MeshTransform(const MeshEntry& entry);

  Vec3d position(const Vec3d& p) const;
  Vec3d direction(const Vec3d& d) const;  ///< any length
  /// By the inverse transpose; any length.
  Vec3d normal(const Vec3d& n) const;
  bool mirrors() const { return scale_[0] * scale_[1] * scale_[2] < 0; }

 private:
  std::array<Vec3d, 3> rotate_{};  // rows
  Vec3d scale_, translate_;
};

}  // namespace torolux
