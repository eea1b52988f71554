// SPDX-License-Identifier: MIT
// Proves: a flat region's triangles do not depend on those of the file; the surface and its texture points stay
// the same; neighbours see the same points on the edges that they share; what needs no change is not touched.
#include "host_tools/mesh/retriangulate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "host_tools/mesh/edges.hpp"
#include "host_tools/mesh/flat_regions.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux::test {
namespace {

double area_of(const Scene& scene) {
  double sum = 0;
  for (const SceneTriangle& t : scene.triangles) {
    const Vec3d& a = scene.positions[t.position[0]];
    sum += 0.5 * vec::length(vec::cross(vec::subtract(scene.positions[t.position[1]], a),
                                        vec::subtract(scene.positions[t.position[2]], a)));
  }
  return sum;
}

/// Each edge of a closed surface has a neighbour, the other way round: no gap, no point within an edge.
bool is_closed(const Scene& scene) {
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (const SceneTriangle& t : scene.triangles) corners.push_back(t.position);
  bool closed = true;
  for_each_edge(edge_uses(corners), [&](std::span<const EdgeUse> uses) {
    closed = closed && uses.size() == 2 && uses[0].forward != uses[1].forward;
  });
  return closed;
}

std::vector<std::array<Vec3d, 3>> sorted_triangles(const Scene& scene) {
  std::vector<std::array<Vec3d, 3>> all;
  for (const SceneTriangle& t : scene.triangles) {
    std::array<Vec3d, 3> corner{scene.positions[t.position[0]], scene.positions[t.position[1]],
                                scene.positions[t.position[2]]};
    std::rotate(corner.begin(), std::ranges::min_element(corner), corner.end());
    all.push_back(corner);
  }
  std::ranges::sort(all);
  return all;
}

/// A wall of 4 x 2 in the plane of z, with a window; cut by a grid of these lines.
Scene wall(const std::vector<double>& xs, const std::vector<double>& ys, bool other_diagonal) {
  SceneBuilder builder;
  const std::uint32_t paint = builder.material({0.5, 0.5, 0.5});
  for (std::size_t i = 0; i + 1 < xs.size(); ++i) {
    for (std::size_t j = 0; j + 1 < ys.size(); ++j) {
      if (xs[i] >= 1 && xs[i + 1] <= 2 && ys[j] >= 0.5 && ys[j + 1] <= 1.5) continue;
      const Vec3d a{xs[i], ys[j], 0};
      const Vec3d b{xs[i + 1], ys[j], 0};
      const Vec3d c{xs[i + 1], ys[j + 1], 0};
      const Vec3d d{xs[i], ys[j + 1], 0};
      if (other_diagonal)
        builder.quad(paint, b, c, d, a);
      else
        builder.quad(paint, a, b, c, d);
    }
  }
  return builder.scene;
}

TEST(Retriangulate, AWallIsTheSameWhateverTheFileCutsItInto) {
  std::vector<double> many{0, 1, 2, 4};
  std::mt19937 random(3);
  for (int i = 0; i < 20; ++i) many.push_back(static_cast<double>(random() >> 8U) * 0x1p-22);
  std::ranges::sort(many);
  std::vector<double> fine;
  for (int i = 0; i <= 16; ++i) fine.push_back(i * 0.25);
  const std::vector<double> ys{0, 0.5, 1.5, 2};
  const std::vector<Scene> walls{wall({0, 1, 2, 4}, ys, false), wall({0, 1, 2, 4}, ys, true), wall(many, ys, false),
                                 wall(many, {0, 0.01, 0.5, 0.51, 1.5, 1.99, 2}, true),
                                 wall(fine, {0, 0.25, 0.5, 0.75, 1, 1.25, 1.5, 1.75, 2}, false)};
  std::vector<std::vector<std::array<Vec3d, 3>>> results;
  for (Scene scene : walls) {
    const double area = area_of(scene);
    retriangulate(scene);
    EXPECT_NEAR(area_of(scene), area, 1e-12);
    results.push_back(sorted_triangles(scene));
  }
  EXPECT_EQ(results[0].size(), 8U) << "as few as the corners allow";
  for (const auto& other : results) EXPECT_EQ(other, results[0]);
}

/// As people build it: a quad below the window, one above, one on each side; their edges end within each other's.
Scene wall_around_window(double width) {
  SceneBuilder builder;
  const std::uint32_t paint = builder.material({0.5, 0.5, 0.5});
  const auto quad = [&](double left, double right, double low, double high) {
    builder.quad(paint, {left, low, 0}, {right, low, 0}, {right, high, 0}, {left, high, 0});
  };
  quad(0, width, 0, 0.5);
  quad(0, width, 1.5, 2);
  quad(0, 1, 0.5, 1.5);
  quad(2, width, 0.5, 1.5);
  return builder.scene;
}

TEST(Retriangulate, QuadsAroundAWindowAreOneWall) {
  Scene grid = wall({0, 1, 2, 4}, {0, 0.5, 1.5, 2}, false);
  Scene quads = wall_around_window(4);
  EXPECT_EQ(flat_regions(quads).all.size(), 4U) << "no edge is another's";
  retriangulate(grid);
  retriangulate(quads);
  EXPECT_EQ(sorted_triangles(quads), sorted_triangles(grid));
  EXPECT_EQ(flat_regions(quads).all.size(), 1U);
}

/// Neither another paint nor another pattern is the same wall: nothing is cut.
TEST(Retriangulate, QuadsOfOtherPaintOrPatternStayWhole) {
  Scene painted = wall_around_window(4);
  painted.materials.push_back(painted.materials[0]);
  for (std::size_t t = 0; t < 4; ++t) painted.triangles[t].material = 1;
  retriangulate(painted);
  EXPECT_EQ(painted.triangles.size(), 8U);
  Scene pattern = wall_around_window(4);
  for (SceneTriangle& t : pattern.triangles) {
    t.texture_points = static_cast<std::uint32_t>(pattern.texture_points.size());
    for (const std::uint32_t p : t.position) {
      const Vec3d& at = pattern.positions[p];
      pattern.texture_points.push_back({at[0] * (t.position[0] % 3 + 1), at[1]});
    }
  }
  retriangulate(pattern);
  EXPECT_EQ(pattern.triangles.size(), 8U);
}

TEST(Retriangulate, WhatNeedsNoChangeIsNotTouched) {
  const Scene before = room_with_box();
  Scene after = before;
  retriangulate(after);
  EXPECT_EQ(after.positions, before.positions);
  ASSERT_EQ(after.triangles.size(), before.triangles.size());
  for (std::size_t t = 0; t < before.triangles.size(); ++t)
    EXPECT_EQ(after.triangles[t].position, before.triangles[t].position);
}

/// A box whose sides are cut by grids of their own lines: what one needs no longer, its neighbours do not, either.
TEST(Retriangulate, NeighboursShareTheirPoints) {
  SceneBuilder builder;
  const std::uint32_t paint = builder.material({0.5, 0.5, 0.5});
  const std::array<double, 4> at{0, 0.1, 0.6, 1};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const double level : {0.0, 1.0}) {
      for (std::size_t i = 0; i < 3; ++i) {
        for (std::size_t j = 0; j < 3; ++j) {
          const auto corner = [&](double u, double v) {
            Vec3d p{};
            p[axis] = level;
            p[(axis + 1) % 3] = u;
            p[(axis + 2) % 3] = v;
            return p;
          };
          const Vec3d a = corner(at[i], at[j]);
          const Vec3d b = corner(at[i + 1], at[j]);
          const Vec3d c = corner(at[i + 1], at[j + 1]);
          const Vec3d d = corner(at[i], at[j + 1]);
          if (level > 0)
            builder.quad(paint, a, b, c, d);
          else
            builder.quad(paint, d, c, b, a);
        }
      }
    }
  }
  Scene scene = builder.scene;
  ASSERT_TRUE(is_closed(scene));
  retriangulate(scene);
  EXPECT_TRUE(is_closed(scene));
  EXPECT_NEAR(area_of(scene), 6, 1e-12);
  EXPECT_EQ(scene.triangles.size(), 12U);
}

/// A border that crosses itself is left as it is, and so are the points that its neighbours share with it.
TEST(Retriangulate, WhatCannotBeCutStaysAndLeavesNoGap) {
  SceneBuilder builder;
  const std::uint32_t paint = builder.material({0.5, 0.5, 0.5});
  // Two triangles of one plane that overlap, over a common edge.
  builder.triangle(paint, {0, 0, 0}, {4, 0, 0}, {1, 2, 0});
  builder.triangle(paint, {4, 0, 0}, {0, 0, 0}, {3, -2, 0});
  builder.triangle(paint, {4, 0, 0}, {3, -2, 0}, {9, 0.5, 0});
  builder.triangle(paint, {4, 0, 0}, {9, -2, 0}, {1, 2, 0});
  Scene scene = builder.scene;
  const double area = area_of(scene);
  retriangulate(scene);
  EXPECT_NEAR(area_of(scene), area, 1e-9);
}

/// Texture points are the file's at every place, but for whole periods.
TEST(Retriangulate, TexturesStayWhereTheyAre) {
  Scene scene = wall({0, 0.1, 1, 2, 3.7, 4}, {0, 0.5, 1.5, 2}, false);
  const auto map = [](const Vec3d& p) { return std::array<double, 2>{3 * p[0] - p[1], 2 * p[1] + 0.25}; };
  for (SceneTriangle& t : scene.triangles) {
    t.texture_points = static_cast<std::uint32_t>(scene.texture_points.size());
    for (const std::uint32_t p : t.position) scene.texture_points.push_back(map(scene.positions[p]));
    for (std::size_t i = 0; i < 3; ++i) scene.texture_points[t.texture_points + i][0] -= t.position[0] % 3;
  }
  const std::size_t before = scene.triangles.size();
  retriangulate(scene);
  EXPECT_LT(scene.triangles.size(), before);
  for (const SceneTriangle& t : scene.triangles) {
    const double moved = std::round(map(scene.positions[t.position[0]])[0] - scene.texture_points[t.texture_points][0]);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto expected = map(scene.positions[t.position[i]]);
      EXPECT_NEAR(expected[0] - scene.texture_points[t.texture_points + i][0], moved, 1e-9);
      EXPECT_NEAR(std::remainder(expected[1] - scene.texture_points[t.texture_points + i][1], 1), 0, 1e-9);
    }
  }
  // Where the pattern does not go on, a region ends.
  Scene broken = wall({0, 0.1, 1, 2, 3.7, 4}, {0, 0.5, 1.5, 2}, false);
  for (SceneTriangle& t : broken.triangles) {
    t.texture_points = static_cast<std::uint32_t>(broken.texture_points.size());
    for (int i = 0; i < 3; ++i) broken.texture_points.push_back({i * 0.3, 0.1 * t.position[0]});
  }
  EXPECT_EQ(flat_regions(broken).all.size(), broken.triangles.size());
}

/// A ring that bends a little at each of many points: none of them is needless for all that it lies near its
/// neighbours' line.
TEST(Retriangulate, ManySmallBendsDoNotAddUp) {
  SceneBuilder builder;
  const std::uint32_t paint = builder.material({0.5, 0.5, 0.5});
  constexpr int kCorners = 4000;  // each 3e-7 of the size off the line between its neighbours
  const auto at = [](int i) {
    const double angle = 2 * 3.14159265358979 * i / kCorners;
    return Vec3d{std::cos(angle), std::sin(angle), 0};
  };
  for (int i = 0; i < kCorners; ++i) builder.triangle(paint, {0, 0, 0}, at(i), at(i + 1 == kCorners ? 0 : i + 1));
  Scene scene = builder.scene;
  const double area = area_of(scene);
  retriangulate(scene);
  EXPECT_GT(scene.triangles.size(), 1500U);
  EXPECT_LT(scene.triangles.size(), 4000U);
  EXPECT_NEAR(area_of(scene), area, 2e-6);
}

}  // namespace
}  // namespace torolux::test
