// SPDX-License-Identifier: MIT
// A triangle and a box enter; whether they touch leaves.
#pragma once

#include <span>

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// corner: three. The box low..high is grown by `margin` >= 0 on all sides. Never false where they touch (13 separating
/// axes, Akenine-Moller 2001, with a little more on every axis for rounding).
bool touches_box(std::span<const Vec3d, 3> corner, const Vec3d& low, const Vec3d& high, double margin);

}  // namespace torolux
