// SPDX-License-Identifier: MIT
// Proves: the solid angle of a triangle is what theory says, for any shape and place; directions lie in it, and are
// spread evenly: their mean is the vector irradiance that Lambert's formula gives; points in its plane, at its edges
// and at a corner give numbers.
#include "firmware/pe/spherical_triangle.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <glm/vec3.hpp>
#include <numbers>
#include <random>

namespace torolux::test {
namespace {

using Ways = std::array<glm::vec3, 3>;
using Vector = glm::dvec3;

Vector unit(const glm::vec3& v) {
  return glm::normalize(Vector(v));
}

/// Twice the arc tangent, in double.
double solid_angle(const Ways& ways) {
  const Vector a = unit(ways[0]);
  const Vector b = unit(ways[1]);
  const Vector c = unit(ways[2]);
  return 2 * std::atan2(std::abs(glm::dot(a, glm::cross(b, c))), 1 + glm::dot(a, b) + glm::dot(b, c) + glm::dot(c, a));
}

/// The integral of the direction over the solid angle: half the sum of the edges' angles times their normals (Lambert
/// 1760, Photometria).
Vector sum_of_directions(const Ways& ways) {
  Vector sum(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector from = unit(ways[i]);
    const Vector to = unit(ways[(i + 1) % 3]);
    const Vector normal = glm::cross(from, to);
    sum += glm::normalize(normal) * (std::atan2(glm::length(normal), glm::dot(from, to)) / 2);
  }
  return glm::dot(sum, unit(ways[0])) + glm::dot(sum, unit(ways[1])) + glm::dot(sum, unit(ways[2])) < 0 ? -sum : sum;
}

Ways random_ways(std::mt19937& random) {
  std::uniform_real_distribution<float> part(-1, 1);
  Ways ways;
  for (glm::vec3& way : ways) way = {part(random), part(random), part(random)};
  return ways;
}

TEST(SphericalTriangle, ArcTangentIsThatOfTheLibrary) {
  for (int i = 0; i <= 10'000; ++i) {
    const double angle = std::numbers::pi * i / 10'000;
    const auto y = static_cast<float>(std::max(0.0, 3 * std::sin(angle)));
    const auto x = static_cast<float>(3 * std::cos(angle));
    ASSERT_NEAR(pe::arc_tangent(y, x), std::atan2(y, x), 1e-6) << y << " / " << x;
  }
}

// Rounding of a unit vector's parts is 6e-8; the arc tangent's own error 1e-6, twice of it. Where a triangle lies
// nearly around the point, or is nearly a line, the quotient is of small numbers: of 10,000 none is off by more than
// 1e-4.
TEST(SphericalTriangle, SolidAngleIsThatOfTheory) {
  std::mt19937 random(1);
  int far_off = 0;
  for (int i = 0; i < 10'000; ++i) {
    const Ways ways = random_ways(random);
    const double off = std::abs(2.0 * static_cast<double>(pe::as_seen(ways).half_angle) - solid_angle(ways));
    ASSERT_LT(off, 1e-4) << i;
    far_off += off > 4e-6 ? 1 : 0;
  }
  EXPECT_LT(far_off, 100);
}

// A grid of 64 x 64 numbers in the middles of their cells: a smooth integrand is off by about one over the square
// of 64.
TEST(SphericalTriangle, DirectionsAreSpreadEvenly) {
  constexpr int kGrid = 64;
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    const Ways ways = random_ways(random);
    const pe::SphericalTriangle triangle = pe::as_seen(ways);
    if (triangle.half_angle < 0.01F) continue;  // too thin for floats to tell its sides apart
    Vector mean(0.0);
    for (int x = 0; x < kGrid; ++x) {
      for (int y = 0; y < kGrid; ++y) {
        const float u = (static_cast<float>(x) + 0.5F) / kGrid;
        const float v = (static_cast<float>(y) + 0.5F) / kGrid;
        mean += Vector(pe::direction_into(triangle, u, v)) / double{kGrid * kGrid};
      }
    }
    const Vector wanted = sum_of_directions(ways) / solid_angle(ways);
    ASSERT_LT(glm::length(mean - wanted), 2e-3) << i << ", solid angle " << solid_angle(ways);
  }
}

// Within rounding: on the inner side of each of its three planes.
TEST(SphericalTriangle, DirectionsLieInIt) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> part(0, 1);
  for (int i = 0; i < 10'000; ++i) {
    const Ways ways = random_ways(random);
    const pe::SphericalTriangle triangle = pe::as_seen(ways);
    if (triangle.half_angle < 0.01F) continue;
    const Vector direction(pe::direction_into(triangle, part(random), part(random)));
    ASSERT_NEAR(glm::length(direction), 1, 1e-6);
    for (std::size_t c = 0; c < 3; ++c) {
      const Vector plane = glm::normalize(glm::cross(unit(ways[c]), unit(ways[(c + 1) % 3])));
      const double inside = glm::dot(plane, unit(ways[(c + 2) % 3])) > 0 ? 1 : -1;
      ASSERT_GT(inside * glm::dot(plane, direction), -1e-4) << i << ", side " << c;
    }
  }
}

TEST(SphericalTriangle, PointsInItsPlaneGiveNumbers) {
  const std::array<Ways, 5> flat = {{{{{1, 0, 0}, {2, 0, 0}, {1, 1, 0}}},              // beside it
                                     {{{1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}}},           // within it
                                     {{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}}},             // on an edge
                                     {{{1, 1, 0}, {2, 2, 0}, {3, 3, 0}}},              // a line
                                     {{{1e-20F, 0, 0}, {1, 0, 0}, {0, 1, 1e-20F}}}}};  // at a corner
  for (const Ways& ways : flat) {
    const pe::SphericalTriangle triangle = pe::as_seen(ways);
    EXPECT_GE(triangle.half_angle, 0.0F);
    EXPECT_LE(triangle.half_angle, 3.1416F);
    for (const float u : {0.0F, 0.3F, 1.0F}) {
      for (const float v : {0.0F, 0.6F, 1.0F}) {
        EXPECT_NEAR(glm::length(pe::direction_into(triangle, u, v)), 1.0F, 1e-5F) << u << ", " << v;
      }
    }
  }
}

}  // namespace
}  // namespace torolux::test
