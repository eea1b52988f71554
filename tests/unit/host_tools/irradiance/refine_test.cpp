// SPDX-License-Identifier: MIT
// Refinement: elements are cut where light changes most, about as many as asked, and the mesh stays balanced.
#include "host_tools/irradiance/refine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "firmware/protocol/triangle_grid.hpp"
#include "tests/unit/host_tools/test_scenes.hpp"

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
  choice.splits = choose_splits(coarse, scene, {{step_of_light(coarse), step_of_light(coarse)}}, coarse.elements / 2);
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
  const std::vector<protocol::Flux> dark(mesh.elements);
  EXPECT_TRUE(choose_splits(mesh, scene, {{dark, dark}}, 100).empty());
}

/// Light per area of 1 everywhere, or as `light` has it, and noise of the given spread, other by each seed.
std::vector<protocol::Flux> noisy(const Mesh& mesh, double spread, unsigned seed,
                                  const std::vector<protocol::Flux>& light = {}) {
  std::mt19937 random(seed);
  std::normal_distribution<double> by_chance(0, spread);
  std::vector<protocol::Flux> flux(mesh.elements);
  for (const MeshPatch& patch : mesh.patches) {
    for (std::uint32_t e = 0; e < patch.elements; ++e) {
      for (std::uint32_t side = 0; side < 2; ++side) {
        if (patch.side[side] == protocol::kNoSide) continue;
        const std::uint32_t element = patch.first_element[side] + e;
        const double area = mesh.element_area(patch, e) * 1e12;
        const double here = light.empty() ? area : static_cast<double>(light[element][0]);
        flux[element].fill(std::llround(here + area * by_chance(random)));
      }
    }
  }
  return flux;
}

// The same differences: where another draft has others they are noise, where it has the same they are light.
TEST(Refine, NoiseIsNoReasonToCut) {
  const Scene scene = floor_scene();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.75, .element_length = 0.19});
  const auto cut = [&](unsigned other_seed) {
    const auto splits = choose_splits(mesh, scene, {{noisy(mesh, 0.2, 1), noisy(mesh, 0.2, other_seed)}}, 100'000);
    return std::ranges::count_if(mesh.facets, [&](const MeshFacet& facet) {
      return std::ranges::binary_search(splits, Split{facet.triangle, facet.code});
    });
  };
  // By chance a few in a thousand differ by as many spreads; more at borders, where corners are guessed.
  EXPECT_LE(cut(2), static_cast<std::ptrdiff_t>(mesh.facets.size() / 20));
  EXPECT_GT(cut(1), static_cast<std::ptrdiff_t>(mesh.facets.size() / 2));
}

// A step of light is cut less deep the more noise the parts would show.
TEST(Refine, PartsMustShowLightMoreThanNoise) {
  const Scene scene = floor_scene();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.75, .element_length = 0.19});
  const auto step = step_of_light(mesh);
  const auto deepest = [&](double spread) {
    std::uint32_t level = 0;
    for (const Split& split :
         choose_splits(mesh, scene, {{noisy(mesh, spread, 1, step), noisy(mesh, spread, 2, step)}}, 100'000)) {
      level = std::max(level, protocol::level_of_code(split.code));
    }
    return level;
  };
  EXPECT_EQ(deepest(0.01), deepest(0));
  EXPECT_EQ(deepest(0.06) + 1, deepest(0));
  EXPECT_EQ(deepest(0.15) + 2, deepest(0));
}

// A step of light is cut as deep as there are records for the parts, and no deeper.
TEST(Refine, PartsMustExpectRecords) {
  const Scene scene = floor_scene();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.75, .element_length = 0.19});
  const auto flux = step_of_light(mesh);
  const double brightest = static_cast<double>(std::ranges::max(flux)[0]) / 3;
  const auto deepest = [&](double records) {  // of both drafts, on the brightest element
    std::uint32_t level = 0;
    for (const Split& split : choose_splits(mesh, scene, {{flux, flux}, 2 * brightest / records}, 100'000)) {
      level = std::max(level, protocol::level_of_code(split.code));
    }
    return level;
  };
  EXPECT_EQ(deepest(20), 0U);
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
