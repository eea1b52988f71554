// SPDX-License-Identifier: MIT
// Refinement: elements are cut where light changes most, about as many as asked, and the mesh stays balanced.
#include "host_tools/mesh/refine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "firmware/protocol/triangle_grid.hpp"
#include "tests/unit/host/test_scenes.hpp"

namespace torolux {
namespace {

/// A floor of edge 1 below a lamp.
Scene floor_scene() {
  test::SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  builder.quad(white, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 4}, {0, 1, 4}, {1, 1, 4});
  return builder.scene;
}

double x_of(const Mesh& mesh, const MeshFacet& facet) {
  const auto corner = grid_corners(mesh.triangles[facet.triangle], facet.code);
  const double left = static_cast<double>(mesh.triangles[0].corner[0][0]);
  return ((corner[0][0] + corner[1][0] + corner[2][0]) / 3 - left) / mesh.space.scale;
}

/// Bright where x is above 0.7, dark below.
std::vector<protocol::Flux> step_of_light(const Mesh& mesh) {
  std::vector<protocol::Flux> flux(mesh.elements);
  for (const MeshPatch& patch : mesh.patches) {
    for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
      const MeshFacet& facet = mesh.facets[f];
      const bool lit = facet.triangle <= 1 && x_of(mesh, facet) > 0.7;
      flux[patch.first_element[0] + facet.element] = {lit ? std::llround(mesh.facet_area(facet) * 1e12) : 0, 0, 0};
    }
  }
  return flux;
}

TEST(Refine, CutsWhereLightChanges) {
  const Scene scene = floor_scene();
  MeshChoice choice{.patch_length = 0.75, .element_length = 0.19};
  const Mesh coarse = make_mesh(scene, choice);
  choice.splits = choose_splits(coarse, scene, {step_of_light(coarse)}, coarse.elements / 2);
  EXPECT_TRUE(std::is_sorted(choice.splits.begin(), choice.splits.end()));
  const Mesh fine = make_mesh(scene, choice);
  EXPECT_GT(fine.elements, coarse.elements + coarse.elements / 3);
  EXPECT_LT(fine.elements, 2 * coarse.elements) << "balancing adds some";
  std::uint32_t level = 0;
  for (const MeshFacet& facet : coarse.facets) level = std::max(level, protocol::level_of_code(facet.code));
  int near = 0;
  int far = 0;
  for (const MeshFacet& facet : fine.facets) {
    if (facet.triangle > 1 || protocol::level_of_code(facet.code) <= level) continue;
    (std::abs(x_of(fine, facet) - 0.7) < 0.25 ? near : far) += 1;
  }
  EXPECT_GT(near, 20);
  EXPECT_EQ(far, 0);
}

TEST(Refine, EvenLightAsksForNothing) {
  const Scene scene = floor_scene();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.75, .element_length = 0.19});
  EXPECT_TRUE(choose_splits(mesh, scene, {std::vector<protocol::Flux>(mesh.elements)}, 100).empty());
}

/// Even light of some 25 records on each element, more or fewer by one spread.
std::vector<protocol::Flux> noisy_light(const Mesh& mesh, std::int64_t of_record) {
  std::vector<protocol::Flux> flux(mesh.elements);
  for (std::size_t e = 0; e < flux.size(); ++e) flux[e].fill((e % 3 == 0 ? 30 : e % 3 == 1 ? 25 : 20) * of_record);
  return flux;
}

// The same differences, of few records and of so many that they must be light.
TEST(Refine, NoiseIsNoReasonToCut) {
  const Scene scene = floor_scene();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.75, .element_length = 0.19});
  constexpr std::int64_t kRecord = 1'000'000;
  const auto cut = [&](double of_record) {
    const auto splits = choose_splits(mesh, scene, {noisy_light(mesh, kRecord), of_record}, 100'000);
    return std::ranges::count_if(mesh.facets, [&](const MeshFacet& facet) {
      return std::ranges::binary_search(splits, Split{facet.triangle, facet.code});
    });
  };
  // At borders, where corners are guessed from one side, noise is more than what is taken off for it.
  EXPECT_LT(cut(kRecord), static_cast<std::ptrdiff_t>(mesh.facets.size() / 10));
  EXPECT_GT(cut(kRecord / 100.0), static_cast<std::ptrdiff_t>(mesh.facets.size() / 2));
}

// A step of light is cut as deep as there are records for the parts, and no deeper.
TEST(Refine, PartsMustExpectRecords) {
  const Scene scene = floor_scene();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.75, .element_length = 0.19});
  const auto flux = step_of_light(mesh);
  const double brightest = static_cast<double>(std::ranges::max(flux)[0]) / 3;
  const auto deepest = [&](double records) {
    std::uint32_t level = 0;
    for (const Split& split : choose_splits(mesh, scene, {flux, brightest / records}, 100'000)) {
      level = std::max(level, protocol::level_of_code(split.code));
    }
    return level;
  };
  EXPECT_EQ(deepest(10), 0U);
  EXPECT_EQ(deepest(100) + 1, deepest(300));
}

// One element is cut three times over: its neighbours follow, so that none lies at the edge of one a quarter its size.
TEST(Refine, MeshStaysBalanced) {
  MeshChoice choice{.patch_length = 2, .element_length = 0.75};
  choice.splits = {{0, 4}, {0, 4U << 2U}, {0, 4U << 4U}};
  const Mesh mesh = make_mesh(floor_scene(), choice);
  for (std::uint32_t k = 0; k < 4; ++k) {
    std::uint32_t deepest = 0;
    std::uint32_t flattest = protocol::kMostLevels;
    // Along the edge that both triangles share, from corner 0 on, at one place on either side.
    for (const auto& [t, b1, b2] : {std::tuple{0U, 0.001F, 0.1F * static_cast<float>(k) + 0.05F},
                                    {1U, 0.1F * static_cast<float>(k) + 0.05F, 0.001F}}) {
      const std::uint32_t level = protocol::level_of_code(mesh.facets[mesh.facet_at(t, b1, b2)].code);
      deepest = std::max(deepest, level);
      flattest = std::min(flattest, level);
    }
    EXPECT_LE(deepest, flattest + 1) << k;
  }
}

}  // namespace
}  // namespace torolux
