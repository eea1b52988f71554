// SPDX-License-Identifier: MIT
// The grid: which cells a polygon stands in, against points sampled on it; and which cell holds a point.
#include "host_tools/subspace/grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "emulator/errors.hpp"
#include "firmware/protocol/stores.hpp"
#include "host_tools/subspace/overlap.hpp"

namespace torolux {
namespace {

using Triangle = std::array<Vec3d, 3>;

Vec3d point_of(const Triangle& triangle, double b1, double b2) {
  Vec3d point{};
  for (std::size_t a = 0; a < 3; ++a) {
    point[a] = triangle[0][a] * (1 - b1 - b2) + triangle[1][a] * b1 + triangle[2][a] * b2;
  }
  return point;
}

bool in_box(const Vec3d& point, double grown) {
  return std::all_of(point.begin(), point.end(), [grown](double x) { return x >= -grown && x <= 1 + grown; });
}

TEST(Overlap, AgreesWithPointsSampledOnTheTriangle) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-0.8, 1.8);
  int touching = 0;
  int claimed_only = 0;
  for (int trial = 0; trial < 4000; ++trial) {
    Triangle triangle{};
    for (Vec3d& corner : triangle) corner = {place(random), place(random), place(random)};
    bool sampled = false;
    constexpr int steps = 40;
    for (int i = 0; i <= steps && !sampled; ++i) {
      for (int j = 0; i + j <= steps && !sampled; ++j) {
        sampled = in_box(point_of(triangle, double(i) / steps, double(j) / steps), 0.01);
      }
    }
    const bool claimed = touches_box(triangle, {0, 0, 0}, {1, 1, 1}, 0.01);
    if (sampled) {
      ++touching;
      EXPECT_TRUE(claimed) << "trial " << trial;
    } else if (claimed) {
      ++claimed_only;
    }
  }
  EXPECT_GT(touching, 1000);
  // Samples 1/40 apart miss only triangles that barely reach into the box: some 2 % of these.
  EXPECT_LT(claimed_only, 120);
}

TEST(Overlap, FaceInABoxFaceStandsOnBothSides) {
  const Triangle triangle{Vec3d{1, 0.2, 0.2}, Vec3d{1, 0.8, 0.2}, Vec3d{1, 0.2, 0.8}};
  EXPECT_TRUE(touches_box(triangle, {0, 0, 0}, {1, 1, 1}, 0));
  EXPECT_TRUE(touches_box(triangle, {1, 0, 0}, {2, 1, 1}, 0));
  EXPECT_FALSE(touches_box(triangle, {1.001, 0, 0}, {2, 1, 1}, 0));
  EXPECT_TRUE(touches_box(triangle, {1.001, 0, 0}, {2, 1, 1}, 0.001));
}

Grid grid_of(std::array<std::uint32_t, 3> cells) {
  return make_grid(SceneSpace{}, cells, 12, 16);
}

TEST(Grid, CellOfPointLiesBetweenItsPlanes) {
  const Grid grid = grid_of({7, 5, 3});
  std::mt19937 random(2);
  std::uniform_real_distribution<float> place(0.0F, 1.0F);
  for (int trial = 0; trial < 10000; ++trial) {
    const protocol::Vec3f point{place(random), place(random), place(random)};
    const auto cell = grid.cell_of(point);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_GE(point[axis], grid.plane(axis, cell[axis]));
      if (cell[axis] + 1 < grid.cells[axis]) {
        EXPECT_LT(point[axis], grid.plane(axis, cell[axis] + 1));
      }
    }
  }
  EXPECT_EQ(grid.cell_of({-5, 0.5F, 9}), (std::array<std::uint32_t, 3>{0, 2, 2}));
}

TEST(Grid, PolygonStandsInEveryCellThatASampleOfItLiesIn) {
  const Grid grid = grid_of({8, 8, 8});
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(0.001F, 0.999F);
  std::vector<MeshTriangle> triangles(200);
  for (MeshTriangle& triangle : triangles) {
    for (protocol::Vec3f& corner : triangle.corner) corner = {place(random), place(random), place(random)};
  }
  triangles.push_back({});  // in a plane between cells
  triangles.back().corner = {protocol::Vec3f{0.1F, 0.5F, 0.1F}, {0.9F, 0.5F, 0.1F}, {0.1F, 0.5F, 0.9F}};
  const auto lists = polygons_by_cell(grid, triangles);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const auto& c = triangles[t].corner;
    const Triangle triangle{to_double(c[0]), to_double(c[1]), to_double(c[2])};
    for (int i = 0; i <= 60; ++i) {
      for (int j = 0; i + j <= 60; ++j) {
        const CellIndex cell = grid.index(grid.cell_of(to_float(point_of(triangle, i / 60.0, j / 60.0))));
        EXPECT_TRUE(std::binary_search(lists[cell].begin(), lists[cell].end(), t)) << t << " in " << cell;
      }
    }
  }
  const auto& below = lists[grid.index({2, 3, 2})];
  EXPECT_TRUE(std::binary_search(below.begin(), below.end(), 200U)) << "a polygon in a plane stands on both sides";
}

TEST(Grid, AutomaticGridFitsSceneAndMachine) {
  EXPECT_EQ(make_grid(SceneSpace{}, {}, 36, 16).cells, (std::array<std::uint32_t, 3>{8, 8, 8}));
  EXPECT_EQ(make_grid(SceneSpace{}, {}, 70'000, 16).cells, (std::array<std::uint32_t, 3>{32, 32, 32}));
  EXPECT_EQ(make_grid(SceneSpace{.size = {1, 0.5, 0.01}}, {}, 36, 16).cells, (std::array<std::uint32_t, 3>{11, 6, 1}));
  EXPECT_GE(make_grid(SceneSpace{}, {}, 36, 1024).count(), 4096U);
  EXPECT_EQ(spread_cells(SceneSpace{}, 36, 1U << 20U), (std::array<std::uint32_t, 3>{3, 3, 3}));
  EXPECT_EQ(spread_cells(SceneSpace{.size = {1, 0.5, 1}}, 12'014, 4U << 20U),
            (std::array<std::uint32_t, 3>{23, 12, 23}));
  EXPECT_EQ(spread_cells(SceneSpace{}, 10'000'000, 64U << 20U), (std::array<std::uint32_t, 3>{64, 64, 64}));
  // 0.75 bytes for each of 22^3 cells are 8 KiB, a 32nd of 256 KiB.
  EXPECT_EQ(spread_cells(SceneSpace{}, 10'000'000, 256U << 10U), (std::array<std::uint32_t, 3>{22, 22, 22}));
  EXPECT_THROW(grid_of({0, 1, 1}), UsageError);
  EXPECT_THROW(grid_of({1025, 1, 1}), UsageError);
  EXPECT_THROW(grid_of({1024, 1024, 8}), UsageError);
}

}  // namespace
}  // namespace torolux
