// SPDX-License-Identifier: MIT
// The product's triples enter; Eigen's vectors and colours leave.
#pragma once

#include <Eigen/Core>

#include "host_tools/scene/scene.hpp"

namespace torolux::references {

using Vec = Eigen::Vector3d;
using Colour = Eigen::Array3d;

inline Vec vec(const Vec3d& v) {
  return {v[0], v[1], v[2]};
}
inline Colour colour(const Vec3d& v) {
  return {v[0], v[1], v[2]};
}

}  // namespace torolux::references
