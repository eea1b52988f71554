// SPDX-License-Identifier: MIT
// Camera rays: where they look, and in which subspace they begin.
#include "host_tools/stages/camera_rays.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "emulator/errors.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

TEST(CameraRays, FieldOfViewIsVerticalAndRowZeroOnTop) {
  const Camera camera{{0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 60};
  const CameraRays rays(camera, SceneSpace{}, 200, 101, PixelSamples(PixelFilter::box, 1, 1), 1);
  const auto top = rays.ray(0 * 200 + 100, 0).direction;
  const auto middle = rays.ray(50 * 200 + 99, 0).direction;
  const auto left = rays.ray(50 * 200, 0).direction;
  // Pixel centres: half a pixel inside the edge.
  const double half = std::tan(std::acos(-1.0) / 6);
  EXPECT_NEAR(static_cast<double>(top[1] / -top[2]), half * (1 - 1.0 / 101), 1e-6);
  EXPECT_NEAR(static_cast<double>(middle[1]), 0, 1e-7);
  EXPECT_NEAR(static_cast<double>(left[0] / -left[2]), -half * 200 / 101 * (1 - 1.0 / 200), 1e-6);
  EXPECT_NEAR(vec::length(to_double(top)), 1, 1e-6);
}

TEST(CameraRays, CamerasThatLookNowhereAreRefused) {
  const auto make = [](const Camera& camera) {
    CameraRays(camera, SceneSpace{}, 4, 4, PixelSamples(PixelFilter::box, 1, 1), 1);
  };
  EXPECT_THROW(make({{0, 0, 0}, {0, 0, 0}, {0, 1, 0}, 40}), InputError);
  EXPECT_THROW(make({{0, 0, 0}, {0, 2, 0}, {0, 1, 0}, 40}), InputError);
  EXPECT_THROW(make({{0, 0, 0}, {1, 0, 0}, {0, 0, 0}, 40}), InputError);
  EXPECT_THROW(make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 180}), InputError);
  EXPECT_THROW(make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0}), InputError);
  EXPECT_THROW(make({{NAN, 0, 0}, {1, 0, 0}, {0, 1, 0}, 40}), InputError);
  EXPECT_NO_THROW(make({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 40}));
}

// A gaussian's samples at the border look at what the picture does not show.
TEST(CameraRays, SamplesMayLieOutsideThePicture) {
  const Camera camera{{0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 90};
  const CameraRays rays(camera, SceneSpace{}, 8, 8, PixelSamples(PixelFilter::gaussian, 64, 1), 1);
  int outside = 0;
  for (std::uint32_t sample = 0; sample < 64; ++sample) {
    const auto direction = rays.ray(0, sample).direction;
    outside += direction[0] < direction[2] || -direction[1] < direction[2] ? 1 : 0;
  }
  EXPECT_GT(outside, 5);
  EXPECT_LT(outside, 40);
}

Grid grid_of(std::array<std::uint32_t, 3> cells) {
  return make_grid(SceneSpace{}, cells, 12, 1);
}

TEST(FirstSubspace, EyeInsideBeginsInItsCell) {
  const Grid grid = grid_of({4, 4, 4});
  const auto first = first_subspace(grid, {0.3F, 0.6F, 0.9F}, {0, 0, 1}, nullptr);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->cell, grid.index({1, 2, 3}));
  EXPECT_EQ(first->flags, protocol::kFirst);
}

TEST(FirstSubspace, RaysFromOutsideEnterWhereTheyMeetTheBox) {
  const Grid grid = grid_of({5, 7, 4});
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-2, 3);
  std::uniform_real_distribution<double> inner(0.01, 0.99);
  int entered = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const Vec3d eye{place(random), place(random), place(random)};
    const Vec3d target{inner(random), inner(random), inner(random)};
    const bool inside = eye[0] > 0 && eye[0] < 1 && eye[1] > 0 && eye[1] < 1 && eye[2] > 0 && eye[2] < 1;
    if (inside) continue;
    const Vec3d direction = vec::unit(vec::subtract(target, eye));
    double t = 0;
    std::size_t axis = 0;
    for (std::size_t a = 0; a < 3; ++a) {
      const double in = ((direction[a] > 0 ? 0 : 1) - eye[a]) / direction[a];
      if (in > t) {
        t = in;
        axis = a;
      }
    }
    const Vec3d at = vec::add(eye, vec::scale(direction, t + 1e-9));
    const auto first = first_subspace(grid, to_float(eye), to_float(direction), nullptr);
    ASSERT_TRUE(first) << trial;
    EXPECT_EQ(first->flags >> protocol::kEntryAxisShift, axis) << trial;
    const auto cell = grid.cell(first->cell);
    for (std::size_t a = 0; a < 3; ++a) {
      // Float rounding of the eye and the direction may move the entry by a few 1e-7.
      EXPECT_GE(at[a] * grid.cells[a], cell[a] - 1e-4) << trial;
      EXPECT_LE(at[a] * grid.cells[a], cell[a] + 1 + 1e-4) << trial;
    }
    ++entered;
  }
  EXPECT_GT(entered, 10000);
}

TEST(FirstSubspace, RaysThatMissAreNotSent) {
  const Grid grid = grid_of({4, 4, 4});
  EXPECT_FALSE(first_subspace(grid, {-1, 0.5F, 0.5F}, {-1, 0, 0}, nullptr));
  EXPECT_FALSE(first_subspace(grid, {-1, 0.5F, 0.5F}, {0, 1, 0}, nullptr));
  EXPECT_FALSE(first_subspace(grid, {-1, 3, 0.5F}, to_float(vec::unit({1, 0.1, 0})), nullptr));
  EXPECT_TRUE(first_subspace(grid, {-1, 0.5F, 0.5F}, {1, 0, 0}, nullptr));
}

TEST(FirstSubspace, EmptySubspacesAreSteppedOver) {
  const Grid grid = grid_of({4, 4, 4});
  std::vector<bool> filled(grid.count(), false);
  filled[grid.index({2, 1, 1})] = true;
  const auto first = first_subspace(grid, {0.1F, 0.3F, 0.3F}, {1, 0, 0}, &filled);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->cell, grid.index({2, 1, 1}));
  EXPECT_EQ(first->flags, 0);  // entered through an x face
  EXPECT_FALSE(first_subspace(grid, {0.1F, 0.3F, 0.3F}, {0, 1, 0}, &filled)) << "meets nothing at all";
}

}  // namespace
}  // namespace torolux
