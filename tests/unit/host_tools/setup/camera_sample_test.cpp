// SPDX-License-Identifier: MIT
// Camera rays followed for predictions: each shows one surface of a diffuse room, and more by shadow rays, lobes and
// glass; those that miss the scene are not sent.
#include "host_tools/setup/camera_sample.hpp"

#include <gtest/gtest.h>

#include "tests/unit/host_tools/test_scenes.hpp"

namespace torolux::test {
namespace {

constexpr std::uint32_t kSize = 32;
constexpr std::uint32_t kRays = 2000;

CameraSample sampled(const Scene& scene, const Camera& camera, CameraSampleChoice choice) {
  const Mesh mesh = make_mesh(scene, {.patch_length = 0.4, .element_length = 0.2});
  const Placement placement = make_placement(mesh, {{2, 2}, std::array<std::uint32_t, 3>{5, 5, 5}, "skewed"});
  choice.pixels = kSize * kSize;
  return sample_camera(scene, mesh, placement,
                       CameraRays(camera, mesh.space, kSize, kSize, PixelSamples(PixelFilter::box, 1, 1), 1), choice,
                       kRays);
}

const Camera kInside{{0.5, 0.8, 0.5}, {0.2, 0.1, 0.5}, {0, 1, 0}, 60};

TEST(CameraSample, ADiffuseRoomShowsOneSurfaceForEachRay) {
  const CameraSample sample = sampled(room_with_box(), kInside, {});
  EXPECT_EQ(sample.sent, 1);
  EXPECT_NEAR(sample.paths.sum().deposits, 1, 1e-9);
  EXPECT_NEAR(sample.paths.sum().starts, 1, 1e-9);
  EXPECT_EQ(sample.paths.sum().turns, 0);
  EXPECT_EQ(sample.paths.escaped, 0);
}

TEST(CameraSample, ShadowRaysAreSegmentsOfTheirOwn) {
  const CameraSample sample = sampled(room_with_box(), kInside, {.shadow_rays = true});
  // None from what faces away from the lamp; the box casts a shadow.
  EXPECT_GT(sample.paths.sum().starts, 1.7);
  EXPECT_LE(sample.paths.sum().starts, 2);
  EXPECT_GT(sample.paths.sum().deposits, 1.5);
  EXPECT_LT(sample.paths.sum().deposits, sample.paths.sum().starts);
}

TEST(CameraSample, LobesGoOnUntilTheyWeighTooLittle) {
  Scene scene = room_with_box();
  for (SceneMaterial& material : scene.materials) {
    material.specular = {0.1, 0.1, 0.1};
    material.exponent = 200;
  }
  // 0.1, with the lobe's own factor, is above 0.05, and its square is not.
  const PathWork work = sampled(scene, kInside, {.least_weight = 0.05}).paths.sum();
  EXPECT_GT(work.deposits, 1.5);
  EXPECT_LE(work.deposits, 2);
  EXPECT_NEAR(sampled(scene, kInside, {.bounces = 1}).paths.sum().deposits, 1, 1e-9);
}

TEST(CameraSample, GlassGivesTwoWays) {
  SceneBuilder builder;
  builder.scene = room_with_box();
  const std::uint32_t glass = builder.glass();
  // A sheet below the eye, which reflects a few hundredths and lets the rest through.
  builder.quad(glass, {0.1, 0.6, 0.1}, {0.1, 0.6, 0.9}, {0.9, 0.6, 0.9}, {0.9, 0.6, 0.1});
  const PathWork work = sampled(builder.scene, kInside, {.least_weight = 1e-3}).paths.sum();
  EXPECT_GT(work.turns, 0.5);
  EXPECT_NEAR(work.starts, 1 + 2 * work.turns, 0.01) << "two ways from each";
  EXPECT_NEAR(work.deposits, 1 + work.turns, 0.01) << "both end at a surface";
}

TEST(CameraSample, RaysThatMissAreNotSent) {
  const Camera outside{{0.5, 0.5, 4}, {0.5, 0.5, 0}, {0, 1, 0}, 40};
  const CameraSample sample = sampled(room_with_box(), outside, {});
  EXPECT_GT(sample.sent, 0.05);
  EXPECT_LT(sample.sent, 0.5);
  EXPECT_EQ(sampled(room_with_box(), {{0.5, 0.5, 4}, {0.5, 0.5, 8}, {0, 1, 0}, 40}, {}).sent, 0);
}

}  // namespace
}  // namespace torolux::test
