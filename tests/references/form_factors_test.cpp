// SPDX-License-Identifier: MIT
// Closed form factors against published values, quadrature, and the rules that all of them obey.
#include "tests/references/form_factors.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace torolux::references {
namespace {

/// Values and catalogue numbers: ../shared/data/references.md, 12 digits.
TEST(FormFactors, AreThePublishedOnes) {
  constexpr double kDigits = 1e-11;
  EXPECT_NEAR(opposite_rectangles(1, 1, 0.5), 0.415253283577, kDigits);
  EXPECT_NEAR(opposite_rectangles(1, 1, 1), 0.199824895698, kDigits);
  EXPECT_NEAR(opposite_rectangles(1, 1, 2), 0.068589588819, kDigits);
  EXPECT_NEAR(opposite_rectangles(1, 1, 10), 0.003162056839, kDigits);
  EXPECT_NEAR(opposite_rectangles(1, 2, 1), 0.285875384851, kDigits);
  EXPECT_NEAR(rectangles_at_an_edge(1, 1, 1), 0.200043776075, kDigits);
  EXPECT_NEAR(rectangles_at_an_edge(2, 1, 1), 0.116426301398, kDigits);
  EXPECT_NEAR(rectangles_at_an_edge(1, 2, 1), 0.232852602795, kDigits);
  const std::array<Vec, 4> square{Vec{0, 0, 1}, Vec{0, 1, 1}, Vec{1, 1, 1}, Vec{1, 0, 1}};
  EXPECT_NEAR(point_to_polygon({0.5, 0.5, 0}, {0, 0, 1}, square), 0.239456470461, kDigits);
  EXPECT_NEAR(point_to_polygon({0, 0, 0}, {0, 0, 1}, square), 0.138531605995, kDigits);
}

/// Mean over a rectangle in z = 0 of the factor from its points to a polygon, by Gauss's rule of 5 points in each of
/// `cells` x `cells` cells.
double mean_factor(const Rectangle& from, std::span<const Vec> to, int cells) {
  constexpr std::array<double, 5> kPlace{-0.906179845938664, -0.538469310105683, 0, 0.538469310105683,
                                         0.906179845938664};
  constexpr std::array<double, 5> kWeight{0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366,
                                          0.236926885056189};
  double sum = 0;
  for (int i = 0; i < 5 * cells; ++i) {
    for (int j = 0; j < 5 * cells; ++j) {
      const auto a = static_cast<std::size_t>(i % 5);
      const auto b = static_cast<std::size_t>(j % 5);
      const int column = i / 5;
      const int row = j / 5;
      const double u = (column + (kPlace[a] + 1) / 2) / cells;
      const double v = (row + (kPlace[b] + 1) / 2) / cells;
      const Vec point(from.x0 + u * (from.x1 - from.x0), from.y0 + v * (from.y1 - from.y0), 0);
      sum += kWeight[a] * kWeight[b] / 4 * point_to_polygon(point, {0, 0, 1}, to);
    }
  }
  return sum / (cells * cells);
}

/// Parallel and perpendicular rectangles at any place, against quadrature: 1e-9 where they do not touch.
TEST(FormFactors, OfRectanglesAnywhereAreTheirQuadrature) {
  const Rectangle from{0.2, 1.1, 0.3, 0.9};
  for (const Rectangle& to : {Rectangle{0.2, 1.1, 0.3, 0.9}, Rectangle{-1, 0.5, 2, 2.5}, Rectangle{3, 4, -2, 3}}) {
    const std::array<Vec, 4> above{Vec{to.x0, to.y0, 0.7}, Vec{to.x0, to.y1, 0.7}, Vec{to.x1, to.y1, 0.7},
                                   Vec{to.x1, to.y0, 0.7}};
    EXPECT_NEAR(parallel_rectangles(from, to, 0.7), mean_factor(from, above, 8), 1e-9);
  }
  for (const Rectangle& to : {Rectangle{0.1, 1, 0.3, 0.9}, Rectangle{0.5, 2, -1, 0.4}, Rectangle{0, 1, 2, 3}}) {
    const std::array<Vec, 4> wall{Vec{0, to.y0, to.x0}, Vec{0, to.y1, to.x0}, Vec{0, to.y1, to.x1},
                                  Vec{0, to.y0, to.x1}};
    EXPECT_NEAR(perpendicular_rectangles(from, to), mean_factor(from, wall, 8), 1e-9);
  }
}

TEST(FormFactors, GeneralFormsHoldTheSimpleOnes) {
  EXPECT_NEAR(parallel_rectangles({0, 2, 0, 3}, {0, 2, 0, 3}, 0.8), opposite_rectangles(2, 3, 0.8), 1e-12);
  EXPECT_NEAR(perpendicular_rectangles({0, 2, 0, 3}, {0, 0.7, 0, 3}), rectangles_at_an_edge(2, 0.7, 3), 1e-12);
}

/// A disc as a polygon of many corners: 1e-6.
TEST(FormFactors, OfDiscsAreTheirQuadrature) {
  constexpr int kCorners = 4096;
  const double r1 = 0.7;
  const double r2 = 1.2;
  const double h = 0.6;
  std::vector<Vec> disc;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * std::numbers::pi * i / kCorners;
    disc.emplace_back(r2 * std::cos(angle), -r2 * std::sin(angle), h);
  }
  double sum = 0;
  constexpr int kRings = 400;
  for (int ring = 0; ring < kRings; ++ring) {  // equal areas
    sum += point_to_polygon({r1 * std::sqrt((ring + 0.5) / kRings), 0, 0}, {0, 0, 1}, disc) / kRings;
  }
  EXPECT_NEAR(coaxial_discs(r1, r2, h), sum, 1e-5);
}

TEST(FormFactors, ObeyReciprocityAndSumToOne) {
  EXPECT_NEAR(opposite_rectangles(1, 1, 1) + 4 * rectangles_at_an_edge(1, 1, 1), 1, 1e-12);
  // A box 1 x 2 x 3, from its 1 x 2 face.
  EXPECT_NEAR(opposite_rectangles(1, 2, 3) + 2 * rectangles_at_an_edge(1, 3, 2) + 2 * rectangles_at_an_edge(2, 3, 1), 1,
              1e-12);
  EXPECT_NEAR(0.5 * 0.5 * coaxial_discs(0.5, 2, 1.3), 2 * 2 * coaxial_discs(2, 0.5, 1.3), 1e-12);
  const Rectangle a{0.1, 0.4, 0, 1};
  const Rectangle b{0.2, 1.7, 0.5, 2};
  EXPECT_NEAR(0.3 * perpendicular_rectangles(a, b), 1.5 * 1.5 * perpendicular_rectangles(b, a), 1e-12);
}

/// What is below the surface does not count: a wall that reaches below it counts as far as it stands above.
TEST(FormFactors, OfAPointSeeNothingBelowTheSurface) {
  const std::array<Vec, 4> wall{Vec{1, -1, -5}, Vec{1, -1, 1}, Vec{1, 1, 1}, Vec{1, 1, -5}};
  const std::array<Vec, 4> upper{Vec{1, -1, 0}, Vec{1, -1, 1}, Vec{1, 1, 1}, Vec{1, 1, 0}};
  const Vec up(0, 0, 1);
  EXPECT_NEAR(point_to_polygon({0, 0, 0}, up, wall), point_to_polygon({0, 0, 0}, up, upper), 1e-12);
  const std::array<Vec, 4> below{Vec{0, 0, -1}, Vec{1, 0, -1}, Vec{1, 1, -1}, Vec{0, 1, -1}};
  EXPECT_EQ(point_to_polygon({0, 0, 0}, up, below), 0);
}

}  // namespace
}  // namespace torolux::references
