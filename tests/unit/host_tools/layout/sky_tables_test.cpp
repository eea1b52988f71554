// SPDX-License-Identifier: MIT
// Proves: the object space's faces look inwards and let in what theory says; named openings take their place; chances
// rise to one and follow the radiance; the machine's table sums up to the host's.
#include "host_tools/layout/sky_tables.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/protocol/sky.hpp"
#include "firmware/protocol/stratified.hpp"
#include "host_tools/layout/chances.hpp"
#include "host_tools/mesh/normalise.hpp"
#include "host_tools/scene/scene_file.hpp"
#include "host_tools/scene/sky.hpp"

namespace torolux {
namespace {

constexpr double kPi = std::numbers::pi;

Scene scene_under(const std::string& table) {
  Scene scene;
  scene.sky = read_scene_file("[sky]\n" + table, "scene.toml").sky;
  return scene;
}

/// 4 x 2 x 1 user units.
SceneSpace space() {
  return {{10, 0, 0}, 0.25, {1, 0.5, 0.25}};
}

TEST(SkyTables, FacesLookInwardsAndLetInWhatFallsOnThem) {
  const std::vector<SkyInlet> inlets = sky_inlets(scene_under("radiance = 1\nground = 0\n"), space());
  ASSERT_EQ(inlets.size(), 5U) << "nothing comes from below";
  double flux = 0;
  for (const SkyInlet& inlet : inlets) {
    const protocol::SkyOpening& face = inlet.opening;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (face.inwards[axis] == 0) continue;
      EXPECT_EQ(face.corner[axis] > 0, face.inwards[axis] < 0);
    }
    flux += inlet.flux[0];
  }
  EXPECT_NEAR(flux, kPi * (4 * 1) + kPi / 2 * 2 * (4 * 2 + 2 * 1), 0.02) << "the top, and the sides, which see half";
}

// Where one part sends nearly all light, the others keep chances, which still rise to one.
TEST(SkyTables, ABrightPartLeavesTheOthersAChance) {
  const std::vector<std::uint32_t> upto = chances({1, 1e30, 0, 1, 1});
  EXPECT_EQ(upto, (std::vector<std::uint32_t>{0, 0xFFFF'FFFDU, 0xFFFF'FFFDU, 0xFFFF'FFFEU, 0xFFFF'FFFFU}));
}

TEST(SkyTables, OpeningsTakeTheFacesPlace) {
  const std::vector<SkyInlet> inlets = sky_inlets(
      scene_under("radiance = 1\n[[sky.opening]]\ncorner = [10, 1, 0]\nedges = [[0, 0, 1], [4, 0, 0]]\n"), space());
  ASSERT_EQ(inlets.size(), 1U);
  EXPECT_EQ(inlets[0].opening.corner, (protocol::Vec3f{0, 0.25F, 0}));
  EXPECT_EQ(inlets[0].opening.inwards, (protocol::Vec3f{0, 1, 0}));
  EXPECT_NEAR(inlets[0].flux[1], 4 * 0.2 * kPi, 0.01) << "what the ground sends up";
}

// Records begin in openings: these are part of the object space, wherever surfaces end.
TEST(SkyTables, OpeningsLieInTheObjectSpace) {
  Scene scene = scene_under("radiance = 1\n[[sky.opening]]\ncorner = [4, -1, 0]\nedges = [[0, 0, 1], [0, 3, 0]]\n");
  scene.positions = {{0, 0, 0}, {3, 0, 0}, {0, 1, 1}};
  scene.triangles.resize(1);
  scene.triangles[0].position = {0, 1, 2};
  const SceneSpace of_all = scene_space(scene);
  for (const SkyInlet& inlet : sky_inlets(scene, of_all)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double begin = inlet.opening.corner[axis];
      const double end = begin + inlet.opening.along[axis] + inlet.opening.across[axis];
      EXPECT_GT(std::min(begin, end), 0) << "axis " << axis;
      EXPECT_LT(std::max(begin, end), of_all.size[axis]) << "axis " << axis;
    }
  }
}

TEST(SkyTables, DrawsSumUpToTheSky) {
  const Scene scene =
      scene_under("model = \"preetham\"\n[sky.sun]\nelevation = 40\nazimuth = 100\nirradiance = [300, 200, 100]\n");
  LightUnits units;
  units.unit_radiance = 10;
  const SkyTables tables = sky_tables(scene, units);
  ASSERT_EQ(tables.entries.size(), protocol::kSkyEntries);
  EXPECT_EQ(tables.entries.back().chosen_to, 0xFFFF'FFFFU);
  Vec3d sum{};
  constexpr std::uint32_t kDraws = 1U << 16U;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const protocol::StratifiedPair pair = protocol::stratified_pair(i, 3);
    const auto draw = protocol::sample_sky(tables.frame, tables.entries, pair.x, protocol::uniform_float(pair.y));
    for (std::size_t c = 0; c < 3; ++c)
      sum[c] += double{draw.radiance_by_solid_angle[c]} / kDraws * units.unit_radiance;
  }
  const Vec3d expected = sky_from_everywhere(*scene.sky);
  for (std::size_t c = 0; c < 3; ++c) {
    EXPECT_NEAR(sum[c] / expected[c], 1, 0.002) << c;
    EXPECT_NEAR(tables.frame.inverse_irradiance[c] * expected[c] / units.unit_radiance, 1, 1e-5);
  }
}

}  // namespace
}  // namespace torolux
