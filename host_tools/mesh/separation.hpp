// SPDX-License-Identifier: MIT
// Two small convex shapes (triangles, segments) and a gap enter; whether they lie apart by more than the gap leaves. In
// double.
#pragma once

#include <span>

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// a, b: corners of a triangle (3) or ends of a segment (2). True only if some axis separates them by more than `gap`;
/// so "false" may also mean that they only come near each other.
bool apart(std::span<const Vec3d> a, std::span<const Vec3d> b, double gap);

}  // namespace torolux
