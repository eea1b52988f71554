// SPDX-License-Identifier: MIT
// Camera rays: where they look, and in which subspace they begin.
#include "host_tools/camera/camera_rays.hpp"

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

/// The direction to a place on the picture [pixels from its upper left corner], in double.
Vec3d direction_to(const Camera& camera, double width, double height, double x, double y) {
  const Vec3d forward = vec::unit(vec::subtract(camera.look_at, camera.eye));
  const Vec3d right = vec::unit(vec::cross(forward, camera.up));
  const Vec3d down = vec::cross(forward, right);
  const double edge = 2 * std::tan(camera.field_of_view_degrees * std::acos(-1.0) / 360) / height;
  const Vec3d aside = vec::add(vec::scale(right, (x - width / 2) * edge), vec::scale(down, (y - height / 2) * edge));
  return vec::unit(vec::add(forward, aside));
}

// Single floats are enough. Each number has 24 bits, so a component is off by a few 6e-8; a place on the picture by a
// few 2^-24 of its width.
TEST(CameraRays, LookWhereADoubleCameraDoes) {
  std::mt19937 random(7);
  const auto below = [&random](std::uint32_t limit) { return static_cast<std::uint32_t>(random() % limit); };
  std::uniform_real_distribution<double> place(-3, 3);
  for (int trial = 0; trial < 300; ++trial) {
    const Camera camera{{place(random), place(random), place(random)},
                        {place(random), place(random), place(random)},
                        {place(random), place(random), place(random)},
                        5 + 30 * std::fabs(place(random))};
    const std::uint32_t width = 1 + below(1000);
    const std::uint32_t height = 1 + below(1000);
    const PixelSamples samples(kPixelFilters[random() % kPixelFilters.size()].filter, 1 + below(20), 3);
    const CameraRays rays(camera, SceneSpace{}, width, height, samples, 3);
    const std::uint32_t column = below(width);
    const std::uint32_t row = below(height);
    const std::uint32_t sample = below(samples.count());
    const CameraRay ray = rays.ray(row * width + column, sample);
    const protocol::CameraPixel pixel = protocol::camera_pixel(rays.view(), column, row);
    const auto distance = [&](std::uint32_t part) {
      return static_cast<double>(protocol::filter_distance(samples.distances(), samples.filter_bits(), part));
    };
    const protocol::SamplePlace at = samples.places()[sample];
    const Vec3d wanted = direction_to(camera, width, height, column + 0.5 + distance(at.x + pixel.moved_x),
                                      row + 0.5 + distance(at.y + pixel.moved_y));
    EXPECT_LT(vec::length(vec::subtract(to_double(ray.direction), wanted)), 5e-7) << trial;
    EXPECT_NEAR(vec::length(to_double(ray.direction)), 1, 2e-7) << trial;
  }
}

// R. Cook et al. 1984: whatever point of the lens a ray leaves, it goes to one point of the plane in focus, that to
// which it would go without a lens; at another distance z the rays fill a disc of radius |1 - z / focus| of the lens's.
TEST(Lens, RaysMeetInFocusAndFillADiscElsewhere) {
  Camera camera{{0.3, 0.4, 2}, {0.3, 0.4, 0}, {0, 1, 0}, 40};
  const SceneSpace space{{0, 0, 0}, 0.5, {1, 1, 1}};
  constexpr std::uint32_t samples = 1024;
  const PixelSamples one_place(PixelFilter::box, samples, 1);
  const CameraRays pinhole(camera, space, 8, 8, one_place, 1);
  camera.aperture = 0.4;
  camera.focus = 1.25;
  const CameraRays lens(camera, space, 8, 8, one_place, 1);
  for (const double z : {0.5, 1.25, 3.0}) {
    const double wanted = 0.2 * std::abs(1 - z / 1.25);
    double farthest = 0;
    double squares = 0;
    Vec3d mean{};
    for (std::uint32_t sample = 0; sample < samples; ++sample) {
      const auto at = [&](const CameraRay& ray) {  // in the plane at z, in the scene's units
        const Vec3d origin = space.to_user(to_double(ray.origin));
        const Vec3d direction = to_double(ray.direction);
        return vec::add(origin, vec::scale(direction, (2 - z - origin[2]) / direction[2]));
      };
      const Vec3d off = vec::subtract(at(lens.ray(21, sample)), at(pinhole.ray(21, sample)));
      farthest = std::max(farthest, vec::length(off));
      squares += vec::dot(off, off) / samples;
      mean = vec::add(mean, vec::scale(off, 1.0 / samples));
    }
    EXPECT_LT(farthest, wanted + 1e-6) << z;
    EXPECT_GE(farthest, 0.98 * wanted) << z;
    // Uniform over the disc: half the radius's square. 1,024 well spread points: seen 0.1 %.
    EXPECT_NEAR(squares, wanted * wanted / 2, 0.01 * wanted * wanted + 1e-12) << z;
    EXPECT_LT(vec::length(mean), 0.01 * wanted + 1e-6) << z;
  }
}

TEST(Lens, WithoutApertureEveryRayIsThePinholes) {
  Camera camera{{0.3, 0.4, 2}, {0, 0, 0}, {0, 1, 0}, 40};
  const CameraRays pinhole(camera, SceneSpace{}, 8, 8, PixelSamples(PixelFilter::tent, 5, 1), 1);
  camera.focus = 3.0;
  const CameraRays same(camera, SceneSpace{}, 8, 8, PixelSamples(PixelFilter::tent, 5, 1), 1);
  EXPECT_FALSE(protocol::has_lens(same.view()));
  for (std::uint32_t pixel = 0; pixel < 64; ++pixel) {
    for (std::uint32_t sample = 0; sample < 5; ++sample) {
      EXPECT_EQ(same.ray(pixel, sample).origin, pinhole.ray(pixel, sample).origin);
      EXPECT_EQ(same.ray(pixel, sample).direction, pinhole.ray(pixel, sample).direction);
    }
  }
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

// Found from a guess, it is the very cell that a walk from the outermost one comes to.
TEST(FirstSubspace, EntryIsThatOfAWalkFromTheEdge) {
  const Grid grid = make_grid(SceneSpace{}, std::array<std::uint32_t, 3>{13, 1, 29}, 12, 1);
  const protocol::GridShape shape = grid.shape();
  std::mt19937 random(11);
  std::uniform_real_distribution<double> inner(-0.1, 1.1);
  std::uniform_real_distribution<double> place(-2, 3);
  int entered = 0;
  for (int trial = 0; trial < 20000; ++trial) {
    const protocol::Vec3f origin = to_float({place(random), place(random), place(random)});
    Vec3d target{inner(random), inner(random), inner(random)};
    if (trial % 2 == 0) {  // at edges between cells, where rounding decides
      target[0] = trial % 4 == 0 ? 0 : 1;
      target[2] = std::round(target[2] * 29) / 29;
    }
    Vec3d direction = vec::subtract(target, to_double(origin));
    if (trial % 10 == 0) direction[static_cast<std::size_t>(trial / 10 % 3)] = 0;
    const protocol::Vec3f way = to_float(vec::unit(direction));
    const auto first = protocol::first_cell(shape, origin, way);
    if (!first || first->flags == protocol::kFirst) continue;
    ++entered;
    const protocol::RayPlanes planes(shape, origin, way);
    const std::size_t axis = first->flags >> protocol::kEntryAxisShift;
    const float entry = planes.distance(axis, planes.upward(axis) ? 0 : grid.cells[axis]);
    for (std::size_t a = 0; a < 3; ++a) {
      const std::uint32_t last = grid.cells[a] - 1;
      std::uint32_t cell = planes.upward(a) ? 0 : last;
      if (!planes.meets(a)) {
        cell = grid.cell_of(origin)[a];
      } else if (a != axis) {
        while (planes.exit(a, cell) < entry && cell != (planes.upward(a) ? last : 0))
          cell += planes.upward(a) ? 1 : ~0U;
      }
      EXPECT_EQ(first->cell[a], cell) << trial << ", axis " << a;
    }
  }
  EXPECT_GT(entered, 10000);
}

TEST(FirstSubspace, CellsOfPointsAreThoseBetweenWhosePlanesTheyLie) {
  const Grid grid =
      make_grid(SceneSpace{{0.1, 0.2, 0.3}, 1, {1, 0.37, 0.71}}, std::array<std::uint32_t, 3>{7, 1023, 32}, 12, 1);
  std::mt19937 random(3);
  std::uniform_real_distribution<float> place(-0.1F, 1.1F);
  for (int trial = 0; trial < 20000; ++trial) {
    protocol::Vec3f point{place(random), place(random), place(random)};
    // On a plane itself, and right below it, too, where rounding decides.
    if (trial % 3 > 0) point[1] = grid.plane(1, static_cast<std::uint32_t>(random() % 1024));
    if (trial % 3 == 1) point[1] = std::nextafter(point[1], -1.0F);
    const auto cell = grid.cell_of(point);
    for (std::size_t a = 0; a < 3; ++a) {
      EXPECT_TRUE(cell[a] == 0 || grid.plane(a, cell[a]) <= point[a]) << trial;
      EXPECT_TRUE(cell[a] + 1 == grid.cells[a] || grid.plane(a, cell[a] + 1) > point[a]) << trial;
    }
  }
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
