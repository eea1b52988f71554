// SPDX-License-Identifier: MIT
// A triangle as it is seen from a point: its solid angle, and directions spread evenly over it, without any functions
// of angles but a sine and an arctangent of our own, so that every machine computes the same bits.
#pragma once

#include <array>

#include "firmware/pe/vectors.hpp"

namespace torolux::pe {

struct SphericalTriangle {
  std::array<glm::vec3, 3> corner;  ///< directions to the corners, unit length
  float half_angle;                 ///< half the solid angle [sr], 0..pi
};

/// Arc tangent of y / x, y >= 0 and not both 0: 0..pi [radian]; errors below 1e-6.
float arc_tangent(float y, float x);

/// ways: from the point to the corners, none of them 0.
SphericalTriangle as_seen(const std::array<glm::vec3, 3>& ways);

/// Unit length. u, v: 0..1; uniform numbers give directions that are uniform over the solid angle, and numbers that
/// keep apart directions that do.
glm::vec3 direction_into(const SphericalTriangle& triangle, float u, float v);

}  // namespace torolux::pe
