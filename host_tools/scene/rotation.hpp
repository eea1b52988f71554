// SPDX-License-Identifier: MIT
// An axis and an angle enter; the rotation about it leaves.
#pragma once

#include <array>

#include "host_tools/scene/scene.hpp"

namespace torolux {

using RotationRows = std::array<Vec3d, 3>;

/// About axis 0, 1 or 2, counter-clockwise where it points to the viewer. Multiples of 90 degrees are exact.
RotationRows rotation(std::size_t axis, double degrees);

Vec3d rotated(const RotationRows& rows, const Vec3d& v);
/// About x, then y, then z, by as many degrees each.
Vec3d rotated(const Vec3d& degrees, const Vec3d& v);

}  // namespace torolux
