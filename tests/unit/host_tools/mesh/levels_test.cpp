// SPDX-License-Identifier: MIT
// Levels: how finely triangles are cut, and the numbers of patches and elements that follow.
#include "host_tools/mesh/levels.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "emulator/errors.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/mesh/mesh_size.hpp"
#include "host_tools/mesh/smooth_surfaces.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux {
namespace {

TEST(Levels, LeastLevelThatIsShortEnough) {
  EXPECT_EQ(level_for(1.0, 1.0), 0);
  EXPECT_EQ(level_for(1.0, 0.99), 1);
  EXPECT_EQ(level_for(1.0, 0.25), 2);
  EXPECT_EQ(level_for(1.0, 0.2499), 3);
  EXPECT_EQ(level_for(1e9, 1e-9), protocol::kMostLevels);
}

struct GridPlace {
  std::uint32_t path, level;
};

/// Of each level, spread over the triangle.
std::vector<GridPlace> grid_places() {
  std::vector<GridPlace> places;
  for (std::uint32_t level = 0; level <= protocol::kMostLevels; ++level) {
    const std::uint32_t paths = protocol::triangles_of_level(level);
    const std::uint32_t step = std::max(1U, paths / 997);  // coprime to powers of 4, so that all children take part
    for (std::uint32_t path = 0; path < paths; path += step) places.push_back({path, level});
  }
  return places;
}

// What the host asks for most is worked out apart from what PEs use: both give the same corners, at each level.
TEST(Levels, GridPointsAreThoseOfTheGridTriangle) {
  for (const GridPlace& place : grid_places()) {
    const std::uint32_t code = protocol::location_code(place.path, place.level);
    const protocol::GridTriangle expected = protocol::grid_triangle_of(code);
    const auto points = grid_points(code);
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(static_cast<std::int32_t>(points[c].i), expected.corner[c][1]) << "code " << code;
      ASSERT_EQ(static_cast<std::int32_t>(points[c].j), expected.corner[c][2]) << "code " << code;
    }
  }
}

// Worked out apart from corners, as PEs place their points by it.
TEST(Levels, TheMiddleOfAGridTriangleIsTheMeanOfItsCorners) {
  for (const GridPlace& place : grid_places()) {
    const protocol::GridTriangle triangle = protocol::grid_triangle(place.path, place.level);
    const auto middle = protocol::middle_of_grid_triangle(place.path, place.level);
    for (std::size_t w = 0; w < 3; ++w) {
      ASSERT_EQ(middle[w], triangle.corner[0][w] + triangle.corner[1][w] + triangle.corner[2][w])
          << "path " << place.path << " of level " << place.level;
    }
  }
}

TEST(Levels, ElementsAreNeverCoarserThanPatches) {
  const Mesh mesh = make_mesh(test::room_with_box(), {.patch_length = 0.1, .element_length = 3.0});
  for (const MeshPatch& patch : mesh.patches) EXPECT_EQ(patch.elements, 1U);
}

TEST(Levels, AutomaticCountsSuitASmallScene) {
  const Mesh mesh = make_mesh(test::room_with_box(), {});
  EXPECT_GE(mesh.patches.size(), 200U);
  EXPECT_LE(mesh.patches.size(), 600U);
  EXPECT_GE(mesh.elements, 2500U);
  EXPECT_LE(mesh.elements, 9000U);
}

// What lengths ask for is counted before anything is made, and is what is made where there are no walls.
TEST(Levels, WhatNoMachineHoldsIsRefusedBeforeItIsMade) {
  test::SceneBuilder builder;
  builder.quad(builder.material({0.5, 0.5, 0.5}), {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
  const Mesh mesh = make_mesh(builder.scene, {.patch_length = 0.3, .element_length = 0.1});
  const std::vector<SizedTriangle> triangles(2, {std::sqrt(2.0), 2});
  const MeshSize size = least_size(triangles, mesh.lengths);
  EXPECT_EQ(size.patches, mesh.patches.size());
  EXPECT_EQ(size.patch_sides, mesh.patch_sides);
  EXPECT_EQ(size.elements, mesh.elements);
  EXPECT_NO_THROW(make_mesh(builder.scene, {.patch_length = 0.3, .element_length = 0.1}, 1)) << "soon made";
  // A thousand triangles of both sides: the least lengths of those asked for, times powers of 2^(1/2), with which there
  // are at most 2^23 patch sides (1/64), 2^26 elements (1/128), or bytes as given or 2^20 elements (1/16).
  const std::vector<SizedTriangle> many(1000, {1.0, 2});
  for (const auto& [lengths, machine, words] :
       {std::tuple(MeshLengths{1e-6, 1e-6, 0}, UINT64_MAX, "use at least --elements 0.0164 --patches 0.0164"),
        {MeshLengths{0.3, 1e-6, 0}, UINT64_MAX, "use at least --elements 0.0082"},
        {MeshLengths{1e-6, 0.3, 0}, UINT64_MAX, "use at least --patches 0.0164"},
        {MeshLengths{0.3, 0.01, 0}, std::uint64_t{1} << 26U, "use at least --elements 0.0801"}}) {
    try {
      require_possible(many, lengths, machine);
      ADD_FAILURE() << words;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  }
}

// A patch's owner holds all its elements: a patch that is chosen by itself leaves room for them, one that is given does
// not change.
TEST(Levels, APatchChosenByItselfFitsIntoMemory) {
  test::SceneBuilder builder;
  builder.quad(builder.material({0.5, 0.5, 0.5}), {0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0});
  const MeshChoice choice{.element_length = 0.006, .patch_factor = 100};
  for (const MeshPatch& patch : make_mesh(builder.scene, choice).patches) EXPECT_EQ(patch.elements, 4096U);
  MeshChoice given = choice;
  given.patch_length = 2;
  EXPECT_EQ(make_mesh(builder.scene, given).patches.size(), 2U);
}

// What a surface is made of does not matter: 70,000 small triangles of one surface get no more patches than a few.
TEST(Levels, FineTessellationMakesNoMorePatches) {
  const std::vector<CutTriangle> few(8, {1.0, 0.5});
  const std::vector<CutTriangle> many(70'000, {0.011, 4.0 / 70'000});
  const MeshLengths a = choose_lengths(few, 1);
  const MeshLengths b = choose_lengths(many, 1);
  EXPECT_NEAR(b.patch / a.patch, 1, 0.5);
  EXPECT_NEAR(b.element / a.element, 1, 0.5);
  const MeshLengths surfaces = choose_lengths(many, 70'000);
  EXPECT_LE(surfaces.patch, 0.012) << "each triangle a surface of its own: each needs a patch";
}

TEST(Levels, MeshNumbersRunOn) {
  const Mesh mesh = make_mesh(test::room_with_box(), {.patch_length = 0.5, .element_length = 0.2});
  std::uint32_t sides = 0;
  std::uint32_t elements = 0;
  std::uint32_t facets = 0;
  for (const MeshPatch& patch : mesh.patches) {
    EXPECT_EQ(patch.first_facet, facets);
    facets += patch.facets;
    for (std::uint32_t s = 0; s < 2; ++s) {
      if (patch.side[s] == protocol::kNoSide) continue;
      EXPECT_EQ(patch.side[s], sides++);
      EXPECT_EQ(patch.first_element[s], elements);
      elements += patch.elements;
    }
  }
  EXPECT_EQ(mesh.facets.size(), facets);
  EXPECT_EQ(mesh.patch_sides, sides);
  EXPECT_EQ(mesh.elements, elements);
}

TEST(Levels, TooManyElementsAreRefusedWithTheNumber) {
  test::SceneBuilder builder{.scene = test::room_with_box()};
  for (int i = 0; i < 5; ++i) builder.box(0, {0.7, 0.1 + i * 0.15, 0.7}, {0.8, 0.2 + i * 0.15, 0.8});
  try {
    make_mesh(builder.scene, {.element_length = 1e-6});
    FAIL() << "not refused";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("67108864"), std::string::npos) << error.what();
  }
}

TEST(Mesh, NormalisedSceneLeavesAMarginAllAround) {
  const Mesh mesh = make_mesh(test::room_with_box(), {});
  for (const MeshTriangle& triangle : mesh.triangles) {
    for (const protocol::Vec3f& corner : triangle.corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GT(corner[axis], 0.0009F);
        EXPECT_LT(corner[axis], mesh.space.size[axis] - 0.0009);
      }
    }
  }
  EXPECT_EQ(mesh.space.size, (Vec3d{1, 1, 1}));
}

}  // namespace
}  // namespace torolux
