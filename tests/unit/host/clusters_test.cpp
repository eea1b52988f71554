// SPDX-License-Identifier: MIT
// Proves that no patch holds more of a fine mesh than its owner has room for, however long patches may be.
#include <gtest/gtest.h>

#include <cmath>

#include "host_tools/mesh/mesh.hpp"

namespace torolux {
namespace {

/// A wavy sheet of 2 x `edge` x `edge` triangles, 10 x 10.
Scene sheet(std::uint32_t edge) {
  Scene scene;
  scene.materials.emplace_back().diffuse = {0.5, 0.5, 0.5};
  for (std::uint32_t j = 0; j <= edge; ++j) {
    for (std::uint32_t i = 0; i <= edge; ++i) {
      const double x = 10.0 * i / edge;
      scene.positions.push_back({x, 0.1 * std::sin(x), 10.0 * j / edge});
    }
  }
  for (std::uint32_t j = 0; j < edge; ++j) {
    for (std::uint32_t i = 0; i < edge; ++i) {
      const std::uint32_t a = j * (edge + 1) + i;
      const std::uint32_t c = a + edge + 2;
      scene.triangles.push_back({{a, a + edge + 1, c}, {kNoNormal, kNoNormal, kNoNormal}, 0});
      scene.triangles.push_back({{a, c, a + 1}, {kNoNormal, kNoNormal, kNoNormal}, 0});
    }
  }
  return scene;
}

TEST(Clusters, APatchHasRoomWithItsOwner) {
  const Mesh mesh = make_mesh(sheet(100), {.patch_length = 100, .element_length = 1});
  std::uint32_t triangles = 0;
  for (const MeshPatch& patch : mesh.patches) {
    EXPECT_LE(patch.triangles, 4096U);
    EXPECT_TRUE(patch.is_clustered());
    triangles += patch.triangles;
  }
  EXPECT_EQ(triangles, 20'000U);
  EXPECT_LT(mesh.patches.size(), 20U);
}

}  // namespace
}  // namespace torolux
