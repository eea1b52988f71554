// SPDX-License-Identifier: MIT
// Light over an element, by what it is at the corners: linear; but on the way to a concave edge, where two surfaces
// light each other, it falls more and more steeply (K. Atkinson, "The planar radiosity equation and its numerical
// solution", IMA Journal of Numerical Analysis 20, 2000: as a power of the distance below 1, by angle and reflectance).
// Over an element that touches one it goes with the square root of the distance.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

#include "firmware/protocol/stores.hpp"
#include "firmware/protocol/triangle_grid.hpp"

namespace torolux::protocol {

/// Bit c: corner c of an element lies on a concave edge.
using ConcaveCorners = std::uint32_t;
/// Of two such corners: the side between them does not lie on the edge, but cuts off a corner of the surface.
inline constexpr ConcaveCorners kSideInside = 0b1000;

/// Light is not negative: signs say what lies on a concave edge. Red's, whether the corner does; the first corner's
/// green, kSideInside.
inline void mark_concave(CornerIrradiance& light, ConcaveCorners concave) {
  const auto mark = [](float& value, bool marked) { value = std::copysign(value, marked ? -1.0F : 1.0F); };
  for (std::size_t c = 0; c < 3; ++c) mark(light.irradiance_over_pi[c][0], (concave >> c & 1U) != 0);
  mark(light.irradiance_over_pi[0][1], (concave & kSideInside) != 0);
}
inline ConcaveCorners concave_corners(const CornerIrradiance& light) {
  const auto& [a, b, c] = light.irradiance_over_pi;
  const auto bit = [](float value, ConcaveCorners of) { return std::signbit(value) ? of : 0U; };
  return bit(a[0], 0b001) | bit(b[0], 0b010) | bit(c[0], 0b100) | bit(a[1], kSideInside);
}
inline Vec3f irradiance_at(const CornerIrradiance& light, std::size_t corner) {
  const Vec3f& at = light.irradiance_over_pi[corner];
  return {std::fabs(at[0]), std::fabs(at[1]), at[2]};
}

/// From the only corner on the edge, by the distance to it: 0 there, 1 at the side opposite.
inline void from_corner(float& corner, float& a, float& b) {
  const float distance = a + b;
  if (!(distance > 0.0F)) return;
  const float root = std::sqrt(distance);
  const float factor = 1.0F / root;
  corner = 1.0F - root;
  a *= factor;
  b *= factor;
}
/// From a side on the edge, by the distance to it, 1 at the corner opposite.
inline void from_side(float& opposite, float& a, float& b) {
  const float root = std::sqrt(std::fmax(opposite, 0.0F));
  const float factor = 1.0F / (1.0F + root);  // (1 - root) / (1 - root^2)
  opposite = root;
  a *= factor;
  b *= factor;
}
/// As the root along the sides from the corners on the edge to the one opposite, and linear along the side inside.
inline void from_side_inside(float& opposite, float& a, float& b) {
  const float distance = a + b;
  const float square = opposite + 4.0F * a * b;
  if (!(distance > 0.0F) || !(square > 0.0F)) return;
  opposite /= std::sqrt(square);
  const float factor = (1.0F - opposite) / distance;
  a *= factor;
  b *= factor;
}

/// How much of each corner's light a point shows. at: its weights of the corners. Along an edge that a whole edge of
/// another element meets it is the same on both sides.
inline Weights light_weights(ConcaveCorners concave, const Weights& at) {
  Weights light = at;
  if (concave == 0) return light;
  const auto from = [&light](ConcaveCorners corner, auto shape) {
    if (corner == 0b001) shape(light.b0, light.b1, light.b2);
    if (corner == 0b010) shape(light.b1, light.b2, light.b0);
    if (corner == 0b100) shape(light.b2, light.b0, light.b1);
  };
  // Of three corners one is on the edge, or one is not, or neither.
  const ConcaveCorners on_edge = concave & 0b111U;
  from(on_edge, from_corner);
  if ((concave & kSideInside) != 0) {
    from(on_edge ^ 0b111U, from_side_inside);
  } else {
    from(on_edge ^ 0b111U, from_side);
  }
  return light;
}

}  // namespace torolux::protocol
