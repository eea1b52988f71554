// SPDX-License-Identifier: MIT
// Where another surface passes through a fine one, that is parted, without holes and without scraps; where it only
// comes near, or lies in its plane, it is not.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "host_tools/mesh/edges.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/mesh/pierced.hpp"

namespace torolux {
namespace {

constexpr std::uint32_t kEdge = 60;
constexpr double kLength = 10.0 / kEdge;             ///< of a triangle
constexpr std::uint32_t kSheet = 2 * kEdge * kEdge;  ///< triangles, the first of the scene

/// A wavy sheet of small triangles, 10 x 10 in x and z, up to 0.15 from y = 0.
Scene sheet() {
  Scene scene;
  scene.materials.emplace_back().diffuse = {0.5, 0.5, 0.5};
  for (std::uint32_t j = 0; j <= kEdge; ++j) {
    for (std::uint32_t i = 0; i <= kEdge; ++i) {
      const double x = 10.0 * i / kEdge;
      const double z = 10.0 * j / kEdge;
      scene.positions.push_back({x, 0.1 * std::sin(x) + 0.05 * std::sin(z), z});
    }
  }
  for (std::uint32_t j = 0; j < kEdge; ++j) {
    for (std::uint32_t i = 0; i < kEdge; ++i) {
      const std::uint32_t a = j * (kEdge + 1) + i;
      const std::uint32_t c = a + kEdge + 2;
      scene.triangles.push_back({{a, a + kEdge + 1, c}, {kNoNormal, kNoNormal, kNoNormal}, 0});
      scene.triangles.push_back({{a, c, a + 1}, {kNoNormal, kNoNormal, kNoNormal}, 0});
    }
  }
  return scene;
}

/// An upright quadrilateral over the line from (x, z) to (x, z), between two heights.
void add_wall(Scene& scene, const std::array<double, 2>& from, const std::array<double, 2>& to, double low = -1,
              double high = 1) {
  const auto first = static_cast<std::uint32_t>(scene.positions.size());
  for (const double y : {low, high}) {
    scene.positions.push_back({from[0], y, from[1]});
    scene.positions.push_back({to[0], y, to[1]});
  }
  scene.triangles.push_back({{first, first + 1, first + 3}, {kNoNormal, kNoNormal, kNoNormal}, 0});
  scene.triangles.push_back({{first, first + 3, first + 2}, {kNoNormal, kNoNormal, kNoNormal}, 0});
}

Mesh mesh_of(const Scene& scene) {
  return make_mesh(scene, {.patch_length = 4, .element_length = 1});
}

/// The sheet's parts across whose edges light passes, each with its triangles; the largest first.
std::vector<std::vector<std::uint32_t>> parts_of(const Mesh& mesh) {
  DisjointSets sets(mesh.triangles.size());
  for (std::uint32_t t = 0; t < kSheet; ++t) {
    for (const std::uint32_t other : mesh.smooth.neighbour[t]) {
      if (other != kNoNeighbour) sets.merge(t, other);
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> by_root;
  for (std::uint32_t t = 0; t < kSheet; ++t) by_root[sets.root(t)].push_back(t);
  std::vector<std::vector<std::uint32_t>> parts;
  for (auto& [root, part] : by_root) parts.push_back(std::move(part));
  std::ranges::sort(parts, std::ranges::greater{}, [](const auto& part) { return part.size(); });
  return parts;
}

Vec3d corner(const Scene& scene, std::uint32_t triangle, std::size_t c) {
  return scene.positions[scene.triangles[triangle].position[c]];
}

TEST(Pierced, ASheetAloneIsWhole) {
  EXPECT_EQ(parts_of(mesh_of(sheet())).size(), 1U);
}

TEST(Pierced, AWallPartsASheet) {
  Scene scene = sheet();
  add_wall(scene, {6.03, -1}, {6.31, 11});
  const auto parts = parts_of(mesh_of(scene));
  ASSERT_EQ(parts.size(), 2U);
  // The wall's own strip goes with the larger part; a corner on its other side may be cut off where no middle lies.
  EXPECT_TRUE(std::ranges::all_of(parts[1], [&](std::uint32_t t) {
    return std::min({corner(scene, t, 0)[0], corner(scene, t, 1)[0], corner(scene, t, 2)[0]}) > 6.03 - kLength;
  }));
  EXPECT_GT(parts[1].size(), kSheet / 10 * 3);
}

TEST(Pierced, AWallThatEndsWithinPartsNothing) {
  Scene scene = sheet();
  add_wall(scene, {6.03, -1}, {6.31, 5});
  EXPECT_EQ(parts_of(mesh_of(scene)).size(), 1U);
}

TEST(Pierced, WhatHangsCloseOverItPartsNothing) {
  Scene scene = sheet();
  add_wall(scene, {6.03, -1}, {6.31, 11}, 0.2, 1);
  EXPECT_EQ(parts_of(mesh_of(scene)).size(), 1U);
}

// A tube stands in the sheet: what it passes through is seen outside, and belongs there.
TEST(Pierced, WhatIsPiercedGoesWithTheLargerPart) {
  Scene scene = sheet();
  constexpr std::array<std::array<double, 2>, 4> foot = {{{3.1, 3.1}, {6.4, 3.2}, {6.5, 6.6}, {3.2, 6.5}}};
  for (std::size_t i = 0; i < 4; ++i) add_wall(scene, foot[i], foot[(i + 1) % 4]);
  const auto parts = parts_of(mesh_of(scene));
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_GT(parts[1].size(), kSheet / 20);
  for (const std::uint32_t t : parts[1]) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Vec3d at = corner(scene, t, c);
      EXPECT_TRUE(at[0] > 3.1 - kLength && at[0] < 6.5 + kLength && at[2] > 3.1 - kLength && at[2] < 6.6 + kLength);
    }
  }
}

MeshTriangle triangle(const std::array<protocol::Vec3f, 3>& corner, std::uint32_t first_position) {
  MeshTriangle result;
  result.corner = corner;
  result.position = {first_position, first_position + 1, first_position + 2};
  return result;
}

// What lies in the very plane, as a vase's foot on a table, passes through nothing: rounding must not decide.
TEST(Pierced, WhatLiesInOnePlaneDoesNot) {
  std::mt19937 random(7);
  std::uniform_real_distribution<float> number(0, 1);
  for (int run = 0; run < 1000; ++run) {
    const protocol::Vec3f origin = {number(random), number(random), number(random)};
    const protocol::Vec3f across = {number(random), number(random), 0};
    const auto at = [&](float a, float b) {
      return protocol::Vec3f{origin[0] + a * across[0], origin[1] + a * across[1], origin[2] + b};
    };
    Mesh mesh;
    mesh.triangles = {triangle({at(0, 0), at(1, 0), at(0, 1)}, 0), triangle({at(1, 0), at(1, 1), at(0, 1)}, 3),
                      triangle({at(-1, -1), at(3, -1), at(-1, 3)}, 6)};
    const Vec3d middle = vec::scale(vec::add(to_double(at(1, 0)), to_double(at(0, 1))), 0.5);
    const std::vector<SmoothEdge> edges = {{{0, 1}, middle}};
    EXPECT_EQ(pierced_triangles(mesh, edges), (std::vector<bool>{false, false, false})) << run;
  }
}

}  // namespace
}  // namespace torolux
