// SPDX-License-Identifier: MIT
// Proves, with whole PEs and fake NIUs: what each layer gets from a camera ray's first surface, that it is the same for
// any number of PEs, and that layers change nothing of the colours.
#include <gtest/gtest.h>

#include <cmath>

#include "firmware/protocol/triangle_grid.hpp"
#include "tests/unit/firmware/pe/fake_machine.hpp"

namespace torolux::test {
namespace {

using protocol::Plane;
using protocol::RayRecord;
using protocol::Stage;

constexpr std::uint32_t kAll = (1U << protocol::kPlanes) - 2U;

RayRecord ray_to(const TestScene& scene, const glm::vec3& origin, const glm::vec3& target, std::uint32_t pixel,
                 std::uint32_t sample) {
  RayRecord r{};
  r.origin = pe::to_array(origin);
  r.direction = pe::to_array(glm::normalize(target - origin));
  r.weight = {0.5F, 0.5F, 0.5F};
  r.place = scene.place_of(origin);
  r.polygon = protocol::kNoPolygon;
  r.key = 7 * pixel + sample;
  r.pixel = pixel;
  r.sample = static_cast<std::uint16_t>(sample);
  r.flags = protocol::kFirst;
  return r;
}

/// Two samples from an eye towards each target, a pixel each.
FakeMachine traced(const TestScene& scene, const glm::vec3& eye, const std::vector<glm::vec3>& targets,
                   std::uint32_t samples = 2) {
  FakeMachine machine(scene.pes);
  machine.begin(scene, Stage::ray_tracing, 64, 1.5F);
  const auto cell = scene.cell_of({eye.x, eye.y, eye.z});
  for (std::uint32_t p = 0; p < targets.size(); ++p) {
    for (std::uint32_t s = 0; s < samples; ++s) {
      const RayRecord r = ray_to(scene, eye, targets[p], p, s);
      const auto* bytes = reinterpret_cast<const std::byte*>(&r);
      machine.send({protocol::kHost, scene.pe_of(cell[0], cell[1], cell[2]), {{bytes, bytes + sizeof(r)}}});
    }
  }
  machine.run();
  EXPECT_EQ(machine.take_credits(), samples * targets.size());
  return machine;
}

/// A room; material 1 a mirror, 2 glass.
TestScene room(std::uint32_t pes = 1, std::array<std::uint32_t, 3> cells = {1, 1, 1}) {
  TestScene s;
  s.pes = pes;
  s.cells = cells;
  s.layers = kAll;
  s.materials = {diffuse_material(0.5F, 0.25F), mirror_material(0.5F), glass_material(1.5F)};
  add_room(s, {0, 0, 0}, {1, 1, 1}, 1, 0);
  for (TestPolygon& p : s.polygons) p.element_level = 2;
  return s;
}

constexpr glm::vec3 kEye{0.2F, 0.5F, 0.5F};

double in_units(std::int64_t value) {
  return static_cast<double>(value) * double{protocol::kLayerUnit};
}

void expect_normal(const std::array<std::int64_t, 3>& sum, const std::array<double, 3>& expected) {
  for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(in_units(sum[a]), expected[a], 1e-6) << "axis " << a;
}

TEST(Layers, TellOfTheFirstSurface) {
  FakeMachine machine = traced(room(), kEye, {{1.0F, 0.5F, 0.5F}, {0.2F, 0.1F, 0.0F}});
  // Towards the wall at x = 1, and the one at z = 0: depth by two samples, normals inwards.
  EXPECT_NEAR(in_units(machine.layers[Plane::depth][0][0]), 2 * 0.8, 1e-6);
  EXPECT_EQ(machine.layers[Plane::depth][0][1], 2);
  EXPECT_NEAR(in_units(machine.layers[Plane::depth][1][0]), 2 * std::sqrt(0.4 * 0.4 + 0.5 * 0.5), 1e-6);
  expect_normal(machine.layers[Plane::normals][0], {-2, 0, 0});
  expect_normal(machine.layers[Plane::normals][1], {0, 0, 2});
  for (const std::uint32_t pixel : {0U, 1U}) {
    EXPECT_NEAR(static_cast<double>(machine.layers[Plane::irradiance][pixel][1]) * 0x1p-20, 1.5, 1e-5)
        << "the mean of two samples, without reflectance and emission";
    EXPECT_EQ(machine.layers[Plane::owner][pixel], (std::array<std::int64_t, 3>{1, 0, 0})) << "one sample's";
  }
}

TEST(Layers, SeenFromBehindNormalsPointToTheEye) {
  TestScene scene = room();
  for (TestPolygon& p : scene.polygons) std::swap(p.corner[1], p.corner[2]);
  FakeMachine machine = traced(scene, kEye, {{1.0F, 0.5F, 0.5F}});
  expect_normal(machine.layers[Plane::normals][0], {-2, 0, 0});
  EXPECT_EQ(machine.layers[Plane::elements][0][1], 0) << "only its front has elements";
  EXPECT_EQ(machine.layers[Plane::elements][0][2], 1);
}

// Towards the middles of elements: the layer names exactly these, by their location codes.
TEST(Layers, ElementsAreThoseUnderTheFirstSample) {
  const TestScene scene = room();
  std::vector<glm::vec3> middles;
  for (const TestPolygon& p : scene.polygons) {
    for (std::uint32_t path = 0; path < 16; ++path) {
      const protocol::GridTriangle grid = protocol::grid_triangle(path, 2);
      glm::vec3 middle(0.0F);
      for (std::size_t w = 0; w < 3; ++w) {
        const auto sum = static_cast<float>(grid.corner[0][w] + grid.corner[1][w] + grid.corner[2][w]);
        middle += pe::to_vector(p.corner[w]) * (sum / (3 << protocol::kMostLevels));
      }
      middles.push_back(middle);
    }
  }
  FakeMachine machine = traced(scene, {0.5F, 0.45F, 0.55F}, middles);
  for (std::uint32_t pixel = 0; pixel < middles.size(); ++pixel) {
    EXPECT_EQ(machine.layers[Plane::elements][pixel],
              (std::array<std::int64_t, 3>{pixel / 16 + 1, 16 + pixel % 16, 0}));
  }
}

// Eight subspaces in a row; the ray begins in the second and ends in the last one.
TEST(Layers, CostIsSubspacesVisited) {
  for (const std::uint32_t pes : {1U, 3U}) {
    FakeMachine machine = traced(room(pes, {8, 1, 1}), kEye, {{1.0F, 0.5F, 0.5F}});
    EXPECT_EQ(machine.layers[Plane::cost][0], (std::array<std::int64_t, 3>{2 * 7, 0, 0})) << pes;
  }
}

TEST(Layers, WhatIsSeenInAMirrorIsNotTheFirstSurface) {
  TestScene scene = room();
  for (TestPolygon& p : scene.polygons) {
    if (p.corner[0][0] != 1 || p.corner[1][0] != 1 || p.corner[2][0] != 1) continue;
    p.material = 1;
    p.sides = 0;
  }
  FakeMachine machine = traced(scene, kEye, {{1.0F, 0.5F, 0.5F}});
  EXPECT_NEAR(in_units(machine.layers[Plane::depth][0][0]), 2 * 0.8, 1e-6);
  EXPECT_EQ(machine.layers[Plane::depth][0][1], 2);
  EXPECT_EQ(machine.layers[Plane::irradiance][0], (std::array<std::int64_t, 3>{0, 0, 0}));
  EXPECT_EQ(machine.layers[Plane::elements][0][1], 0);
  EXPECT_EQ(machine.layers[Plane::cost][0][0], 2 * 2) << "there and back";
}

/// The room with a lamp and shadow rays.
TestScene lit_room(float reflectance) {
  TestScene s = room();
  s.materials[0] = diffuse_material(reflectance);
  s.materials.push_back(diffuse_material(0.0F, 3));
  add_wall(s, {0.3F, 0.3F, 0.6F}, {0, 0.4F, 0}, {0.4F, 0, 0}, 1, 3);
  aim_at(s, 3);
  return s;
}

// What comes by shadow rays is irradiance as well, also on a surface that reflects nothing of it.
TEST(Layers, IrradianceHoldsWhatShadowRaysBring) {
  const std::vector<glm::vec3> floor{{0.5F, 0.5F, 0.0F}};
  const glm::vec3 eye{0.1F, 0.1F, 0.3F};
  FakeMachine grey = traced(lit_room(0.5F), eye, floor, 512);
  const double colour = static_cast<double>(grey.pixels[0][0]);
  const double irradiance = static_cast<double>(grey.layers[Plane::irradiance][0][0]);
  EXPECT_GT(irradiance, 1.2 * 256 * 1.5 * 0x1p20) << "more than the vertices'";
  EXPECT_NEAR(colour / irradiance, 0.5, 1e-5);
  FakeMachine black = traced(lit_room(0.0F), eye, floor, 512);
  EXPECT_EQ(black.layers[Plane::irradiance], grey.layers[Plane::irradiance]);
  EXPECT_EQ(black.pixels[0], (std::array<std::int64_t, 3>{0, 0, 0}));
  EXPECT_EQ(grey.layers[Plane::depth][0][1], 512) << "shadow rays meet no first surface";
  TestScene covered = lit_room(0.5F);
  add_wall(covered, {0.2F, 0.2F, 0.55F}, {0, 0.6F, 0}, {0.6F, 0, 0}, 1, 0);
  FakeMachine shadow = traced(covered, eye, floor, 512);
  EXPECT_NEAR(static_cast<double>(shadow.layers[Plane::irradiance][0][0]), 256 * 1.5 * 0x1p20, 1e3) << "rounding";
  TestScene glazed = lit_room(0.5F);
  glazed.materials.push_back(pane_material(1.5F, 0.5F));
  add_wall(glazed, {0.2F, 0.2F, 0.55F}, {0, 0.6F, 0}, {0.6F, 0, 0}, 1,
           static_cast<std::uint16_t>(glazed.materials.size() - 1));
  glazed.polygons.back().sides = glazed.polygons[glazed.polygons.size() - 2].sides = 0;
  FakeMachine behind = traced(glazed, eye, floor, 512);
  const double dimmed = static_cast<double>(behind.layers[Plane::irradiance][0][0]);
  EXPECT_GT(dimmed, 1.05 * 256 * 1.5 * 0x1p20) << "what a pane lets through";
  EXPECT_LT(dimmed, 0.9 * irradiance);
  EXPECT_NEAR(static_cast<double>(behind.pixels[0][0]) / dimmed, 0.5, 1e-5);
}

/// Mirror, glass, shadow rays; eyes towards many places.
TestScene everything(std::uint32_t pes, std::array<std::uint32_t, 3> cells, std::uint32_t layers) {
  TestScene s = lit_room(0.5F);
  s.pes = pes;
  s.cells = cells;
  s.layers = layers;
  s.least_weight = 1e-3F;
  const std::size_t walls = s.polygons.size();
  add_ball(s, {0.5F, 0.8F, 0.3F}, 0.15F, 6, 2, true);
  add_ball(s, {0.8F, 0.3F, 0.3F}, 0.12F, 6, 1, true);
  for (std::size_t i = walls; i < s.polygons.size(); ++i) s.polygons[i].sides = 0;
  return s;
}

std::vector<glm::vec3> many_targets() {
  std::vector<glm::vec3> targets;
  for (int y = 0; y < 16; ++y) {
    for (int x = 0; x < 16; ++x) {
      targets.emplace_back(1.0F, (static_cast<float>(x) + 0.5F) / 16, (static_cast<float>(y) + 0.5F) / 16);
    }
  }
  return targets;
}

TEST(Layers, ChangeNoColour) {
  const FakeMachine without = traced(everything(1, {2, 2, 2}, 0), {0.05F, 0.45F, 0.4F}, many_targets());
  EXPECT_TRUE(without.layers.empty()) << "nothing is sent where nothing is asked for";
  for (std::uint32_t plane = 1; plane < protocol::kPlanes; ++plane) {
    const FakeMachine with = traced(everything(1, {2, 2, 2}, 1U << plane), {0.05F, 0.45F, 0.4F}, many_targets());
    EXPECT_EQ(with.layers.size(), 1U) << plane;
    EXPECT_EQ(with.pixels, without.pixels) << plane;
  }
}

TEST(Layers, SameBitsWhateverTheMachine) {
  FakeMachine one = traced(everything(1, {1, 1, 1}, kAll), {0.05F, 0.45F, 0.4F}, many_targets());
  FakeMachine other = traced(everything(7, {3, 4, 5}, kAll), {0.05F, 0.45F, 0.4F}, many_targets());
  FakeMachine fewer = traced(everything(2, {3, 4, 5}, kAll), {0.05F, 0.45F, 0.4F}, many_targets());
  EXPECT_EQ(other.pixels, one.pixels);
  for (const Plane plane : {Plane::irradiance, Plane::depth, Plane::normals, Plane::elements}) {
    EXPECT_EQ(one.layers[plane].size(), 256U);
    EXPECT_EQ(other.layers[plane], one.layers[plane]);
  }
  EXPECT_EQ(other.layers[Plane::cost], fewer.layers[Plane::cost]) << "depends on the grid, not on the PEs";
  EXPECT_NE(other.layers[Plane::cost], one.layers[Plane::cost]);
  EXPECT_NE(other.layers[Plane::owner], one.layers[Plane::owner]);
}

}  // namespace
}  // namespace torolux::test
