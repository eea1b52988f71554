// SPDX-License-Identifier: MIT
// Elements that walls part: each side's pieces are an element of their own.
#include "host_tools/mesh/wall_pieces.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux {
namespace {

constexpr MeshChoice kChoice{.patch_length = 0.5, .element_length = 0.25};
/// Elements are cut at level 3, twice more at walls, and pieces twice again.
constexpr double kStep = 1.0 / 128;

/// A floor of edge 1 with a wall on it, at x = 0.3, so far along y.
Scene floor_with_wall(double until) {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  builder.quad(white, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  if (until > 0) builder.quad(white, {0.3, 0, 0}, {0.3, until, 0}, {0.3, until, 1}, {0.3, 0, 1});
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 4}, {0, 1, 4}, {1, 1, 4});
  return builder.scene;
}

struct Extent {
  double least = HUGE_VAL, most = -HUGE_VAL;  ///< x
  double shares = 0;
};

/// Of the floor's elements, by patch and number.
std::map<std::pair<std::uint32_t, std::uint32_t>, Extent> extents(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, Extent> result;
  for (std::uint32_t p = 0; p < mesh.patches.size(); ++p) {
    const MeshPatch& patch = mesh.patches[p];
    for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
      const MeshFacet& facet = mesh.facets[f];
      if (facet.triangle > 1) continue;
      Extent& extent = result[{p, facet.element}];
      extent.shares += facet.of_element;
      for (const Vec3d& corner : grid_corners(mesh.triangles[facet.triangle], facet.code)) {
        const double x = corner[0] / mesh.space.scale + mesh.space.origin[0];
        extent.least = std::min(extent.least, x);
        extent.most = std::max(extent.most, x);
      }
    }
  }
  return result;
}

TEST(WallPieces, NoElementLiesOnBothSidesOfAWall) {
  const Mesh mesh = make_mesh(floor_with_wall(1), kChoice);
  int beside = 0;
  for (const auto& [element, extent] : extents(mesh)) {
    EXPECT_FALSE(extent.least < 0.3 - kStep && extent.most > 0.3 + kStep) << extent.least << " " << extent.most;
    EXPECT_NEAR(extent.shares, 1, 1e-12);
    if (std::abs(extent.least - 0.3) < kStep || std::abs(extent.most - 0.3) < kStep) ++beside;
  }
  EXPECT_GT(beside, 2 * 16);
}

TEST(WallPieces, PointsAreFoundInThem) {
  const Mesh mesh = make_mesh(floor_with_wall(1), kChoice);
  int pieces = 0;
  for (std::uint32_t f = 0; f < mesh.facets.size(); ++f) {
    const MeshFacet& facet = mesh.facets[f];
    pieces += facet.is_piece ? 1 : 0;
    const PlanePoint middle = middle_of_grid(facet.code);
    EXPECT_EQ(mesh.facet_at(facet.triangle, static_cast<float>(middle.b1), static_cast<float>(middle.b2)), f);
  }
  EXPECT_GT(pieces, 100);
}

TEST(WallPieces, OnePieceWhereLightGetsAround) {
  const Mesh without = make_mesh(floor_with_wall(0), kChoice);
  const Mesh mesh = make_mesh(floor_with_wall(0.01), kChoice);
  std::uint32_t crossed = 0;
  for (const MeshFacet& facet : mesh.facets) {
    if (facet.triangle <= 1 && mesh.walls.cross(facet.triangle, facet.code)) ++crossed;
    EXPECT_FALSE(facet.is_piece);
  }
  EXPECT_GT(crossed, 0U);
  EXPECT_GT(mesh.facets.size(), without.facets.size());
}

// Where a block stands on the floor, its foot is neither seen nor an element of its own.
TEST(WallPieces, WhatAThingHidesIsNotSeen) {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  builder.quad(white, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  builder.box(white, {0.31, 0.33, 0}, {0.69, 0.68, 0.4});
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 4}, {0, 1, 4}, {1, 1, 4});
  const Mesh mesh = make_mesh(builder.scene, kChoice);
  double seen = 0;
  for (const MeshFacet& facet : mesh.facets) {
    if (facet.triangle > 1) continue;
    EXPECT_FALSE(facet.is_piece);
    const bool under = facet.seen == 1 && is_hidden(mesh, facet.triangle, facet.code);
    if (!under) seen += mesh.facet_area(facet) * facet.seen;
  }
  // Steps of pieces lie to both sides of the foot.
  EXPECT_NEAR(seen, 1 - (0.69 - 0.31) * (0.68 - 0.33), 0.01);
}

TEST(Walls, PartWhatLiesOnBothSides) {
  const Mesh mesh = make_mesh(floor_with_wall(0.5), kChoice);
  // Triangle 0: corners (0, 0), (1, 0), (1, 1); weights 1 and 2 are x - y and y.
  const PlanePoint left{0.15, 0.05};
  EXPECT_TRUE(mesh.walls.part(0, left, {0.35, 0.05}));
  EXPECT_FALSE(mesh.walls.part(0, left, {0.05, 0.05}));
  EXPECT_FALSE(Walls().part(0, left, {0.35, 0.05}));
}

}  // namespace
}  // namespace torolux
