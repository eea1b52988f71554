// SPDX-License-Identifier: MIT
// Two corners and a point on the side to the third cut off a part of the triangle; u chooses that part's area, v a
// place on the arc to the point (Arvo 1995, Stratified Sampling of Spherical Triangles). Tangents of half angles take
// the place of his angles.
#include "firmware/pe/spherical_triangle.hpp"

#include <cmath>
#include <glm/geometric.hpp>

namespace torolux::pe {
namespace {

constexpr float kPi = 3.14159265F;

/// Of 0..1 (Abramowitz & Stegun 1964, 4.4.49).
float arc_tangent_of(float x) {
  const float q = x * x;
  const float high =
      0.1065626393F + q * (-0.0752896400F + q * (0.0429096138F + q * (-0.0161657367F + q * 0.0028662257F)));
  return x * (1.0F + q * (-0.3333314528F + q * (0.1999355085F + q * (-0.1420889944F + q * high))));
}

/// Of 0..pi.
SineCosine sine_cosine_of_wide(float angle) {
  const SineCosine quarter = sine_cosine(angle * 0.25F);
  const SineCosine half{2.0F * quarter.sine * quarter.cosine, 1.0F - 2.0F * quarter.sine * quarter.sine};
  return {2.0F * half.sine * half.cosine, 1.0F - 2.0F * half.sine * half.sine};
}

/// What of `v` is at right angles to `axis` (unit length), unit length; `axis` itself where nothing is.
glm::vec3 across(const glm::vec3& v, const glm::vec3& axis) {
  const glm::vec3 rest = v - axis * glm::dot(v, axis);
  const float square = glm::dot(rest, rest);
  return square > 0.0F ? rest * (1.0F / std::sqrt(square)) : axis;
}

}  // namespace

float arc_tangent(float y, float x) {
  const float far = std::fabs(x);
  const float acute = y <= far ? arc_tangent_of(y / far) : kPi / 2.0F - arc_tangent_of(far / y);
  return x < 0.0F ? kPi - acute : acute;
}

SphericalTriangle as_seen(const std::array<glm::vec3, 3>& ways) {
  const glm::vec3 a = glm::normalize(ways[0]);
  const glm::vec3 b = glm::normalize(ways[1]);
  const glm::vec3 c = glm::normalize(ways[2]);
  // Van Oosterom & Strackee 1983, The Solid Angle of a Plane Triangle.
  const float volume = std::fabs(glm::dot(a, glm::cross(b, c)));
  const float rest = 1.0F + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a);
  return {{a, b, c}, volume > 0.0F ? arc_tangent(volume, rest) : 0.0F};
}

glm::vec3 direction_into(const SphericalTriangle& triangle, float u, float v) {
  const auto& [a, b, c] = triangle.corner;
  // The point is cos(s) a + sin(s) side; of the part that a, b and it cut off, the tangent of half the area is
  // t |a, b, side| / (1 + ab + t (side b)), with t = tan(s / 2). That area is wanted: t = rise / run.
  const glm::vec3 side = across(c, a);
  const float cosine = glm::dot(a, b);
  const float beside = glm::dot(side, b);
  const SineCosine wanted = sine_cosine_of_wide(triangle.half_angle * u);
  const float rise = wanted.sine * (1.0F + cosine);
  const float run = std::fabs(glm::dot(a, glm::cross(b, side))) * wanted.cosine - beside * wanted.sine;
  const float square = rise * rise + run * run;
  if (!(square > 0.0F)) return b;
  const float inverse = 1.0F / square;
  const glm::vec3 point = a * ((run * run - rise * rise) * inverse) + side * (2.0F * rise * run * inverse);

  const float along = 1.0F - v * (1.0F - glm::dot(point, b));
  const float aside = 1.0F - along * along;
  return glm::normalize(b * along + across(point, b) * (aside > 0.0F ? std::sqrt(aside) : 0.0F));
}

}  // namespace torolux::pe
