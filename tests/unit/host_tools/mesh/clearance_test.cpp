// SPDX-License-Identifier: MIT
// How far the next surface is: right to the last digit, and none but what a side sees before it; elements follow it.
#include "host_tools/mesh/clearance.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/mesh/triangle_tree.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux {
namespace {

using Triangle = TriangleTree::Triangle;

Vec3d any_point(std::mt19937& random) {
  std::uniform_real_distribution<double> x(0, 1);
  return {x(random), x(random), x(random)};
}

/// By points all over the triangle. Never less than the true one.
double sampled_distance(const Triangle& triangle, const Outlook& outlook) {
  constexpr int steps = 200;
  const auto& [a, b, c] = triangle.corner;
  double nearest = HUGE_VAL;
  for (int i = 0; i <= steps; ++i) {
    for (int j = 0; i + j <= steps; ++j) {
      const Vec3d point = vec::add(a, vec::add(vec::scale(vec::subtract(b, a), i / double{steps}),
                                               vec::scale(vec::subtract(c, a), j / double{steps})));
      const Vec3d way = vec::subtract(point, outlook.point);
      if (vec::dot(way, outlook.normal) >= outlook.rise) nearest = std::min(nearest, vec::length(way));
    }
  }
  return nearest;
}

// Of 300 triangles, against points of all of them; they lie within 1 / 200 of an edge, shorter than 0.35, of the
// nearest one.
TEST(TriangleTree, FindsTheNearestPointOverThePlane) {
  std::mt19937 random(7);
  std::vector<Triangle> triangles(300);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    triangles[t].corner[0] = any_point(random);
    for (std::size_t i = 1; i < 3; ++i)
      triangles[t].corner[i] = vec::add(triangles[t].corner[0], vec::scale(any_point(random), 0.2));
    triangles[t].surface = t / 100;
  }
  const TriangleTree tree(triangles);
  for (std::uint32_t i = 0; i < 20; ++i) {
    const Outlook outlook{.point = any_point(random),
                          .normal = vec::unit(vec::subtract(any_point(random), {0.5, 0.5, 0.5})),
                          .rise = 0.02,
                          .own = i % 3};
    double expected = 0.3;
    for (const Triangle& triangle : triangles)
      if (triangle.surface != outlook.own) expected = std::min(expected, sampled_distance(triangle, outlook));
    const double found = tree.distance(outlook, 0.3);
    EXPECT_LE(found, expected + 1e-12);
    EXPECT_GT(found, expected - 0.35 / 200);
  }
}

TEST(TriangleTree, WithoutTrianglesAllIsClear) {
  EXPECT_EQ(TriangleTree().distance({.point = {0, 0, 0}, .normal = {0, 0, 1}}, 3), 3);
  EXPECT_EQ(TriangleTree(std::vector<Triangle>{}).distance({.point = {0, 0, 0}, .normal = {0, 0, 1}}, 3), 3);
}

/// A floor of edge 4, lit from far above, and whatever else stands there.
struct Floor {
  test::SceneBuilder builder;
  std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  Floor() {
    builder.quad(white, {0, 0, 0}, {4, 0, 0}, {4, 4, 0}, {0, 4, 0});
    builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 6}, {0, 4, 6}, {4, 4, 6});
  }
  /// By the place of its middle, the longest edge of the floor's element there [user units].
  double length_at(double x, double y) const {
    const Mesh mesh = make_mesh(builder.scene, {.patch_length = 2, .element_length = 0.5});
    double length = 0;
    double nearest = HUGE_VAL;
    for (const MeshFacet& facet : mesh.facets) {
      const auto corner = grid_corners(mesh.triangles[facet.triangle], facet.code);
      const Vec3d middle = mesh.space.to_user(vec::scale(vec::add(vec::add(corner[0], corner[1]), corner[2]), 1.0 / 3));
      if (std::abs(middle[2]) > 1e-3) continue;
      const double far = std::hypot(middle[0] - x, middle[1] - y);
      if (far > nearest) continue;
      nearest = far;
      length = vec::length(vec::subtract(corner[1], corner[0])) / mesh.space.scale;
      for (std::size_t i = 1; i < 3; ++i) {
        length = std::max(length, vec::length(vec::subtract(corner[(i + 1) % 3], corner[i])) / mesh.space.scale);
      }
    }
    return length;
  }
};

// The floor's edges are halved until none is longer than 0.5: 0.354. Once more under a table, not far beside it.
TEST(Clearance, ElementsAreSmallerUnderWhatHangsOverThem) {
  Floor floor;
  EXPECT_NEAR(floor.length_at(1.5, 1.5), 0.3536, 0.0001);
  floor.builder.quad(floor.white, {1, 1, 0.08}, {1, 2, 0.08}, {2, 2, 0.08}, {2, 1, 0.08});
  EXPECT_NEAR(floor.length_at(1.5, 1.5), 0.1768, 0.0001);
  EXPECT_NEAR(floor.length_at(3.5, 3.5), 0.3536, 0.0001);
}

TEST(Clearance, WhatIsFarAboveDoesNotCount) {
  Floor floor;
  floor.builder.quad(floor.white, {1, 1, 0.4}, {1, 2, 0.4}, {2, 2, 0.4}, {2, 1, 0.4});
  EXPECT_NEAR(floor.length_at(1.5, 1.5), 0.3536, 0.0001);
}

// An open floor's back has light, too, but so has the inside of many a thin thing.
TEST(Clearance, WhatIsBehindDoesNotCount) {
  Floor floor;
  floor.builder.quad(floor.white, {1, 1, -0.08}, {2, 1, -0.08}, {2, 2, -0.08}, {1, 2, -0.08});
  EXPECT_NEAR(floor.length_at(1.5, 1.5), 0.3536, 0.0001);
}

// What stands on a floor is a wall, and cuts only the elements that it touches: smaller ones beside a room's edges were
// found to be noisier, and no better (docs/decisions/elements.md).
TEST(Clearance, WhatStandsOnAFloorDoesNotCount) {
  Floor floor;
  floor.builder.quad(floor.white, {1, 1.02, 0}, {3, 1.02, 0}, {3, 1.02, 3}, {1, 1.02, 3});
  EXPECT_NEAR(floor.length_at(2, 1.3), 0.3536, 0.0001);
}

// 30 degrees: each would hang over the other, were they not one surface. With a slit between them they are two.
TEST(Clearance, PartsOfOneFoldedSurfaceDoNotHangOverEachOther) {
  for (const double slit : {0.0, 0.001}) {
    Floor floor;
    const double rise = 2 * std::tan(std::numbers::pi / 6);
    floor.builder.quad(floor.white, {4 + slit, 0, 0}, {6, 0, rise}, {6, 4, rise}, {4 + slit, 4, 0});
    EXPECT_NEAR(floor.length_at(3.9, 2), slit == 0 ? 0.3536 : 0.1768, 0.0001);
  }
}

// Of a heap of leaves each lies close under another.
TEST(Clearance, SmallThingsAreNotCut) {
  Floor floor;
  for (int i = 0; i < 50; ++i) {
    const double z = 1 + 0.05 * i;
    floor.builder.quad(floor.white, {1, 1, z}, {1.08, 1, z}, {1.08, 1.08, z}, {1, 1.08, z});
  }
  const Mesh mesh = make_mesh(floor.builder.scene, {.patch_length = 2, .element_length = 0.5});
  std::size_t leaves = 0;
  for (const MeshPatch& patch : mesh.patches) {
    if (patch.area > 0.01) continue;
    ++leaves;
    EXPECT_EQ(patch.elements, 1U);
  }
  EXPECT_GE(leaves, 50U);
}

/// A wavy sheet of many small triangles, 4 x 4, so high over the floor, its front downwards.
void add_sheet(Floor& floor, double height) {
  constexpr int edge = 80;
  const auto at = [height](int i, int j) {
    const double x = 4.0 * i / edge;
    const double y = 4.0 * j / edge;
    return Vec3d{x, y, height + 0.02 * std::sin(3 * x) * std::sin(3 * y)};
  };
  for (int j = 0; j < edge; ++j) {
    for (int i = 0; i < edge; ++i) {
      floor.builder.triangle(floor.white, at(i, j), at(i + 1, j + 1), at(i + 1, j));
      floor.builder.triangle(floor.white, at(i, j), at(i, j + 1), at(i + 1, j + 1));
    }
  }
}

/// Elements of clusters of many triangles.
std::size_t clustered_elements(const Floor& floor) {
  const Mesh mesh = make_mesh(floor.builder.scene, {.patch_length = 2, .element_length = 0.5});
  std::size_t elements = 0;
  for (const MeshPatch& patch : mesh.patches)
    if (patch.is_clustered()) elements += patch.elements;
  return elements;
}

// Elements a quarter as long are sixteen times as many; an eighth, the least there is, 64. Clusters have no even sizes:
// half and twice are told apart.
TEST(Clearance, ClustersAreSmallerWhereAnotherSurfaceIsNear) {
  std::array<std::size_t, 3> elements{};
  constexpr std::array<double, 3> heights{1.0, 0.125, 0.05};
  for (std::size_t i = 0; i < heights.size(); ++i) {
    Floor floor;
    add_sheet(floor, heights[i]);
    elements[i] = clustered_elements(floor);
  }
  EXPECT_GT(elements[0], 32U);
  EXPECT_GT(elements[1], 8 * elements[0]);
  EXPECT_LT(elements[1], 32 * elements[0]);
  EXPECT_GT(elements[2], 2 * elements[1]);
}

}  // namespace
}  // namespace torolux
