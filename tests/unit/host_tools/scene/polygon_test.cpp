// SPDX-License-Identifier: MIT
// Proves that polygons are cut into triangles that cover them once, with their winding, whatever their plane.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <numbers>

#include "host_tools/scene/polygon_triangles.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

Vec3d area_vector(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return vec::scale(vec::cross(vec::subtract(b, a), vec::subtract(c, a)), 0.5);
}

Vec3d area_vector(const std::vector<Vec3d>& polygon) {
  Vec3d sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum = vec::add(sum, area_vector(polygon[0], polygon[i], polygon[i + 1]));
  return sum;
}

/// Every triangle faces as the polygon, and their areas add up to it: together they cover it exactly once.
void expect_covered(const std::vector<Vec3d>& polygon, double tolerance) {
  const PolygonTriangles cut = cut_polygon(polygon);
  const Vec3d whole = area_vector(polygon);
  double sum = 0;
  for (const auto& t : cut.triangles) {
    const Vec3d part = area_vector(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
    EXPECT_GE(vec::dot(part, whole), 0);
    sum += vec::length(part);
  }
  EXPECT_FALSE(cut.crosses_itself);
  EXPECT_NEAR(sum, vec::length(whole), tolerance * vec::length(whole));
}

TEST(Polygon, SquareIsCutFromItsFirstCorner) {
  const PolygonTriangles cut = cut_polygon(std::vector<Vec3d>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}});
  ASSERT_EQ(cut.triangles.size(), 2U);
  EXPECT_EQ(cut.triangles[0], (std::array<std::uint32_t, 3>{0, 1, 2}));
}

TEST(Polygon, ConcaveOnes) {
  expect_covered({{0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {2, 1, 0}, {0, 4, 0}}, 1e-12);
  expect_covered({{0, 0, 0}, {0, 3, 0}, {1, 3, 0}, {1, 1, 0}, {3, 1, 0}, {3, 0, 0}}, 1e-12);
  // An arrow whose tip is the first corner: a fan from there would cover its outside.
  expect_covered({{0, 0, 0}, {3, 1, 0}, {1, 1, 0}, {1, 3, 0}}, 1e-12);
}

// A quad whose corners stand in the wrong order: what it encloses one way round is as much as the other way.
TEST(Polygon, ABowTieIsToldToCrossItselfAlsoWhereItIsSymmetric) {
  for (const double turned : {0.0, 0.3, 1.1}) {
    std::vector<Vec3d> tie;
    for (const auto& [x, y] : {std::pair(0.0, 0.0), std::pair(1.0, 1.0), std::pair(1.0, 0.0), std::pair(0.0, 1.0)})
      tie.push_back({x * std::cos(turned) - 0.3 * y, y, x * std::sin(turned) + 0.1 * y});
    const PolygonTriangles cut = cut_polygon(tie);
    EXPECT_TRUE(cut.crosses_itself) << turned;
    EXPECT_EQ(cut.triangles.size(), 2U) << turned;
  }
  const PolygonTriangles line = cut_polygon(std::vector<Vec3d>{{0, 0, 0}, {1, 1, 0}, {3, 3, 0}, {2, 2, 0}});
  EXPECT_TRUE(line.triangles.empty());
  EXPECT_FALSE(line.crosses_itself);
}

TEST(Polygon, CornersOnStraightEdgesStayCorners) {
  const std::vector<Vec3d> polygon{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {2, 2, 0}, {1, 2, 0}, {0, 2, 0}};
  expect_covered(polygon, 1e-12);
  EXPECT_EQ(cut_polygon(polygon).triangles.size(), 4U);
}

TEST(Polygon, WithAHoleJoinedByASeam) {
  expect_covered(
      {{0, 0, 0}, {6, 0, 0}, {6, 6, 0}, {0, 6, 0}, {0, 0, 0}, {2, 2, 0}, {2, 4, 0}, {4, 4, 0}, {4, 2, 0}, {2, 2, 0}},
      1e-12);
}

TEST(Polygon, CrossingItselfIsSaid) {
  const PolygonTriangles cut = cut_polygon(std::vector<Vec3d>{{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {1, 3, 0}, {0, 2, 0}});
  EXPECT_LE(cut.triangles.size(), 3U);
  EXPECT_FALSE(cut.triangles.empty());
}

TEST(Polygon, WithoutAreaThereIsNothing) {
  EXPECT_TRUE(cut_polygon(std::vector<Vec3d>{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}}).triangles.empty());
  EXPECT_TRUE(cut_polygon(std::vector<Vec3d>{{0, 0, 0}, {1, 1, 1}}).triangles.empty());
}

RC_GTEST_PROP(PolygonProperty, StarShapedPolygonsAreCovered, ()) {
  const auto corners = *rc::gen::inRange<std::size_t>(4, 40);
  const auto seeds = *rc::gen::container<std::vector<int>>(corners, rc::gen::inRange(1, 1000));
  const Vec3d u = vec::unit({1.0 * *rc::gen::inRange(-9, 10) + 0.5, 1.0 * *rc::gen::inRange(-9, 10), 1});
  const Vec3d v = vec::unit(vec::cross(u, {0.3, 1, 1.0 * *rc::gen::inRange(-9, 10)}));
  std::vector<Vec3d> polygon;
  for (std::size_t i = 0; i < corners; ++i) {
    const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(corners);
    const double radius = 0.05 + seeds[i] / 1000.0;
    polygon.push_back(vec::add(vec::scale(u, radius * std::cos(angle)), vec::scale(v, radius * std::sin(angle))));
  }
  // Rounding of a rotated plane is far below this; a missing or doubled triangle far above.
  expect_covered(polygon, 1e-9);
  RC_ASSERT(cut_polygon(polygon).triangles.size() == corners - 2);
}

}  // namespace
}  // namespace torolux
