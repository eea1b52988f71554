// SPDX-License-Identifier: MIT
// Paths followed for predictions: none is lost, a closed room keeps all light, and hand-overs are counted where the
// allocation makes them.
#include "host_tools/setup/path_sample.hpp"

#include <gtest/gtest.h>

#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux::test {
namespace {

Placement placed(const Mesh& mesh, TorusSize torus, std::uint32_t cells) {
  return make_placement(mesh, {torus, std::array<std::uint32_t, 3>{cells, cells, cells}, "skewed"});
}

double hits_of(const PathSample& sample) {
  double sum = 0;
  for (const auto& sides : sample.hits) sum += sides[0] + sides[1];
  return sum;
}

TEST(PathSample, AClosedRoomKeepsAllLight) {
  const Scene scene = room_with_box();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.4, .element_length = 0.2});
  const LightSample light = sample_light(scene, mesh, placed(mesh, {1, 1}, 5), 32, 500);
  for (const PathSample* sample : {&light.emitted, &light.reflected}) {
    EXPECT_EQ(sample->escaped, 0);
    EXPECT_NEAR(sample->sum().deposits, 1, 1e-9);
    EXPECT_NEAR(hits_of(*sample), 1, 1e-9);
    EXPECT_EQ(sample->sum().hand_overs + sample->sum().sent_light, 0) << "one PE";
    EXPECT_GT(sample->sum().steps, 1);
  }
  // The lamp hangs below the ceiling and faces down: its light falls on floor and box first, and on the ceiling later.
  EXPECT_GT(light.emitted.sum().tests, 1);
}

TEST(PathSample, HandOversFollowTheAllocation) {
  const Scene scene = room_with_box();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.4, .element_length = 0.2});
  const PathSample one = sample_light(scene, mesh, placed(mesh, {1, 1}, 6), 32, 500).emitted;
  const PathSample many = sample_light(scene, mesh, placed(mesh, {3, 2}, 6), 32, 500).emitted;
  EXPECT_EQ(one.sum().steps, many.sum().steps) << "the same paths";
  // Each step crosses into another PE's subspace in a skewed allocation, and a deposit may go back to its owner.
  EXPECT_NEAR(many.sum().hand_overs, many.sum().steps, 1e-9);
  EXPECT_GT(many.sum().sent_light, 0);
}

TEST(PathSample, WhatIsCommonIsHandedToNobody) {
  const Scene scene = room_with_box();
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.4, .element_length = 0.2});
  const Grid grid = make_grid(mesh.space, std::array<std::uint32_t, 3>{6, 6, 6}, mesh.triangles.size(), 6);
  const auto emitted = [&](std::vector<bool> common) {
    const PlacementChoice choice{{3, 2}, std::nullopt, "skewed", Scheme::spread};
    const Placement placement =
        make_placement(mesh, list_cells(mesh, grid), choice, {protocol::Stage::radiosity, nullptr, std::move(common)});
    return sample_light(scene, mesh, placement, 32, 500).emitted;
  };
  const PathSample all = emitted(std::vector<bool>(grid.count(), true));
  EXPECT_EQ(all.sum().hand_overs, 0);
  EXPECT_NEAR(all.anywhere.starts, 1, 1e-9) << "each path is followed where it is made";
  EXPECT_NEAR(all.sum().sent_light, 5.0 / 6, 1e-9) << "one of six PEs has what the light falls on";
  const PathSample none = emitted({});
  EXPECT_GT(none.sum().hand_overs, 5.0 / 6);
  EXPECT_LT(none.sum().hand_overs, none.sum().steps) << "empty subspaces are stepped over";
  EXPECT_NEAR(none.sum().tests, all.sum().tests, 1e-9) << "the same paths";
  EXPECT_EQ(none.anywhere.tests, 0) << "nobody but its owner looks into a subspace";
}

TEST(PathSample, LightLeavesAnOpenScene) {
  SceneBuilder builder;
  const std::uint32_t lamp = builder.material({0, 0, 0}, {1, 1, 1});
  const std::uint32_t wall = builder.material({0.5, 0.5, 0.5});
  // The lamp faces up, away from the wall below it.
  builder.quad(lamp, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1});
  builder.quad(wall, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  const Mesh mesh = make_mesh(builder.scene, {.patch_length = 0.5, .element_length = 0.5});
  const PathSample emitted = sample_light(builder.scene, mesh, placed(mesh, {2, 2}, 4), 32, 200).emitted;
  EXPECT_EQ(emitted.escaped, 1);
  EXPECT_EQ(hits_of(emitted), 0);
}

TEST(PathSample, MirrorsTurnAndGlassLetsThrough) {
  SceneBuilder builder;
  const std::uint32_t lamp = builder.material({0, 0, 0}, {1, 1, 1});
  const std::uint32_t wall = builder.material({0.5, 0.5, 0.5});
  const std::uint32_t glass = builder.glass();
  builder.box(wall, {0, 0, 0}, {1, 1, 1}, true);
  builder.quad(lamp, {0.4, 0.4, 0.1}, {0.6, 0.4, 0.1}, {0.6, 0.6, 0.1}, {0.4, 0.6, 0.1});
  builder.quad(glass, {0, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5});
  Scene mirrored = builder.scene;
  mirrored.materials[glass].kind = SurfaceKind::mirror;
  mirrored.materials[glass].specular = {0.9, 0.9, 0.9};
  const auto top = [](const Scene& scene) {
    const Mesh mesh = make_mesh(scene, {.patch_length = 0.5, .element_length = 0.5});
    const PathSample emitted = sample_light(scene, mesh, placed(mesh, {1, 1}, 3), 32, 500).emitted;
    EXPECT_GT(emitted.sum().turns, 0.3);
    double hits = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      bool high = true;
      for (const auto& corner : mesh.triangles[t].corner) high = high && corner[2] > 0.9F;
      if (high) hits += emitted.hits[t][0] + emitted.hits[t][1];
    }
    return hits;
  };
  EXPECT_GT(top(builder.scene), 0.2) << "a cosine lobe over 0.9 of the room's height sends it about a quarter";
  EXPECT_EQ(top(mirrored), 0) << "nothing gets past a mirror";
}

// All surfaces reflect by narrow lobes 0.4 times the cosine of the light, whose mean is 2/3 where light comes from
// everywhere: so of its flux light falls on 1 / (1 - 0.4 * 2/3) = 1.36 surfaces.
TEST(PathSample, LobesSendLightOn) {
  Scene scene = room_with_box();
  for (SceneMaterial& material : scene.materials) {
    material.specular = {0.4, 0.4, 0.4};
    material.exponent = 200;
  }
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.4, .element_length = 0.2});
  const PathSample sample = sample_light(scene, mesh, placed(mesh, {3, 2}, 5), 32, 2000).emitted;
  EXPECT_NEAR(sample.sum().deposits, 1 + sample.sum().turns, 1e-9) << "where a path goes on it has fallen before";
  EXPECT_NEAR(sample.sum().starts, sample.sum().deposits, 1e-9);
  EXPECT_NEAR(hits_of(sample), 1.36, 0.07) << "a lamp's first light is steeper than that";
  const PathSample once = sample_light(scene, mesh, placed(mesh, {3, 2}, 5), 1, 2000).emitted;
  EXPECT_NEAR(once.sum().deposits, 1, 1e-9) << "one bounce";
}

}  // namespace
}  // namespace torolux::test
