// SPDX-License-Identifier: MIT
// Proves that no patch holds more of a fine mesh than its owner has room for, however long patches may be, and that the
// clusters that count at its vertices stay few.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "host_tools/irradiance/vertex_irradiance.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {
namespace {

/// Nowhere flat.
double waves(double x, double z) {
  return 0.1 * std::sin(x) + 0.05 * std::sin(z);
}
/// 10 x 10 bumps, each with slopes of more than 30 degrees: of several clusters.
double bumps(double x, double z) {
  return 0.15 * std::sin(2 * std::numbers::pi * x) * std::sin(2 * std::numbers::pi * z);
}

/// A wavy sheet of 2 x `edge` x `edge` triangles, 10 x 10.
Scene sheet(std::uint32_t edge, double (*height)(double, double) = waves) {
  Scene scene;
  scene.materials.emplace_back().diffuse = {0.5, 0.5, 0.5};
  for (std::uint32_t j = 0; j <= edge; ++j) {
    for (std::uint32_t i = 0; i <= edge; ++i) {
      const double x = 10.0 * i / edge;
      const double z = 10.0 * j / edge;
      scene.positions.push_back({x, height(x, z), z});
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

// Many more clusters than may count lie within an element's length. Work and memory, counted: a list for each vertex
// that does not grow with the clusters; and what is left in it still carries the light.
TEST(Clusters, FewCountAtAVertexHoweverManyAreNear) {
  const Mesh mesh = make_mesh(sheet(150, bumps), {.patch_length = 100, .element_length = 100});
  const IrradiancePlan plan(mesh);
  const ClusterVertices& front = plan.side[0].clusters;
  ASSERT_GT(front.clusters().size(), 4 * ClusterVertices::kMostNear);
  std::vector<bool> counts(front.clusters().size(), false);
  for (const ClusterVertices::Vertex& vertex : front.vertices()) {
    ASSERT_GE(vertex.near, 1U);
    ASSERT_LE(vertex.near, ClusterVertices::kMostNear);
    for (const ClusterVertices::Near& at : front.near(vertex)) counts[at.cluster] = true;
  }
  EXPECT_EQ(std::ranges::count(counts, true), static_cast<std::ptrdiff_t>(counts.size()));
}

}  // namespace
}  // namespace torolux
