// SPDX-License-Identifier: MIT
// Proves: triangulations fill exactly the region that the border bounds, with Delaunay's property, for any order of its
// edges; borders that bound nothing are refused.
#include "host_tools/mesh/delaunay.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host_tools/mesh/plane_predicates.hpp"

namespace torolux::test {
namespace {

using Points = std::vector<LatticePoint>;

Triangulation::Border loop(std::uint32_t first, std::uint32_t count) {
  Triangulation::Border border;
  for (std::uint32_t i = 0; i < count; ++i) border.emplace_back(first + i, first + (i + 1) % count);
  return border;
}

std::array<LatticePoint, 3> corners_of(const Triangulation& t, const std::array<std::uint32_t, 3>& triangle) {
  return {t.points()[triangle[0]], t.points()[triangle[1]], t.points()[triangle[2]]};
}

/// Twice.
std::int64_t area_of(const Triangulation& t) {
  std::int64_t sum = 0;
  for (const auto& triangle : t.triangles()) {
    const auto c = corners_of(t, triangle);
    const std::int64_t area = plane::turn(c[0], c[1], c[2]);
    EXPECT_GT(area, 0);
    sum += area;
  }
  return sum;
}

/// A wall of 1000 x 400 with a window of 300 x 200.
const Points kWall{{0, 0},     {1000, 0},  {1000, 400}, {0, 400},
                   {500, 100}, {500, 300}, {800, 300},  {800, 100}};  // the window clockwise

Triangulation::Border wall_border() {
  Triangulation::Border border = loop(0, 4);
  for (const auto& edge : loop(4, 4)) border.push_back(edge);
  return border;
}

TEST(Delaunay, FillsAWallAroundItsWindow) {
  const auto wall = Triangulation::make(kWall, wall_border());
  ASSERT_TRUE(wall);
  EXPECT_EQ(area_of(*wall), 2 * (400'000 - 60'000));
  EXPECT_EQ(wall->triangles().size(), 8U);  // points + 2 holes - 2
}

TEST(Delaunay, RefusesWhatBoundsNothing) {
  EXPECT_FALSE(Triangulation::make(kWall, loop(4, 4))) << "the outside of a loop has no end";
  EXPECT_FALSE(Triangulation::make(Points{{0, 0}, {10, 10}, {10, 0}, {0, 10}}, loop(0, 4))) << "crosses itself";
  EXPECT_FALSE(Triangulation::make(Points{{0, 0}, {9, 0}, {9, 9}, {0, 0}}, loop(0, 4))) << "a point twice";
  EXPECT_FALSE(Triangulation::make(Points{{0, 0}, {10, 0}, {10, 10}, {5, 0}}, {{0, 1}, {1, 2}, {2, 0}}))
      << "an edge through a point";
  EXPECT_FALSE(Triangulation::make(Points{{0, 0}, {10, 0}, {10, 10}}, {{0, 1}, {1, 2}})) << "open";
}

/// Star-shaped outlines, with points anywhere inside that are none of the border.
TEST(Delaunay, FillsAnyOutlineWithEmptyCircles) {
  const bool holds = rc::check([] {
    const auto count = *rc::gen::inRange(3U, 40U);
    Points points;
    std::int64_t area = 0;
    for (std::uint32_t i = 0; i < count; ++i) {
      const double radius = *rc::gen::inRange(1000, 1'000'000);
      const double angle = 2 * std::numbers::pi * i / count;
      points.push_back(
          {static_cast<std::int32_t>(radius * std::cos(angle)), static_cast<std::int32_t>(radius * std::sin(angle))});
    }
    for (std::uint32_t i = 0; i < count; ++i) area += plane::turn({0, 0}, points[i], points[(i + 1) % count]);
    for (std::uint32_t i = 0; i < count; ++i)  // a star needs turns of less than half a circle
      RC_PRE(plane::turn({0, 0}, points[i], points[(i + 1) % count]) > 0);
    auto border = loop(0, count);
    std::ranges::reverse(border);
    auto t = Triangulation::make(points, border);
    RC_PRE(t.has_value());  // fails where a point lies on an edge by rounding
    RC_ASSERT(area_of(*t) == area);
    RC_ASSERT(t->triangles().size() == count - 2);
    for (const auto& one : t->triangles()) {  // no point that it sees lies in its circle: neighbours, over edges inside
      for (const auto& two : t->triangles()) {
        std::uint32_t apart = 0;
        std::uint32_t shared = 0;
        for (const std::uint32_t p : two) {
          if (std::ranges::find(one, p) == one.end())
            apart = p;
          else
            ++shared;
        }
        if (shared == 2) RC_ASSERT(plane::in_circle(corners_of(*t, one), t->points()[apart]) <= 0);
      }
    }
  });
  EXPECT_TRUE(holds);
}

}  // namespace
}  // namespace torolux::test
