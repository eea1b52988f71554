// SPDX-License-Identifier: MIT
// Proves, with whole PEs and fake NIUs: what a ray adds to its pixel, through mirror and glass, branches included; the
// same bits for any number of PEs; every ray ends as one credit, after its light.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "firmware/protocol/random.hpp"
#include "tests/unit/firmware/pe/fake_machine.hpp"

namespace torolux::test {
namespace {

using protocol::RayRecord;
using protocol::Stage;

RayRecord ray_from(const TestScene& scene, const glm::vec3& origin, const glm::vec3& target, std::uint32_t pixel) {
  RayRecord r{};
  r.origin = pe::to_array(origin);
  r.direction = pe::to_array(glm::normalize(target - origin));
  r.weight = {1, 1, 1};
  r.place = scene.place_of(origin);
  r.polygon = protocol::kNoPolygon;
  r.key = protocol::hash_combine(scene.seed, pixel);
  r.pixel = pixel;
  r.flags = protocol::kFirst;
  return r;
}

/// From the host, six to a packet, and all that follows; the credits that came home.
std::uint32_t trace(FakeMachine& machine, const TestScene& scene, const std::vector<RayRecord>& rays) {
  for (const RayRecord& r : rays) {
    const auto cell = scene.cell_of({r.origin[0], r.origin[1], r.origin[2]});
    const auto* bytes = reinterpret_cast<const std::byte*>(&r);
    machine.send({protocol::kHost, scene.pe_of(cell[0], cell[1], cell[2]), {{bytes, bytes + sizeof(r)}}});
  }
  machine.run();
  for (const auto& p : machine.pes) EXPECT_EQ(p->free_niu_slots(), p->niu_slots());
  return machine.take_credits();
}

TestScene furnace(std::uint32_t pes, std::array<std::uint32_t, 3> cells) {
  TestScene s;
  s.pes = pes;
  s.cells = cells;
  s.materials = {diffuse_material(0.5F, 0.25F), mirror_material(0.5F), glass_material(1.5F, 1.0F)};
  add_room(s, {0, 0, 0}, {1, 1, 1}, 3, 0);
  for (TestPolygon& p : s.polygons) p.element_level = 2;
  return s;
}

std::vector<RayRecord> rays_at_random(const TestScene& scene, std::uint32_t count) {
  std::mt19937 random(2);
  const auto number = [&] { return static_cast<float>(random() >> 8U) * 0x1p-24F; };
  std::vector<RayRecord> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    rays.push_back(ray_from(scene, {0.02F, 0.02F + 0.9F * number(), 0.5F}, {0.9F, number(), number()}, i / 2));
  }
  return rays;
}

// Radiance of a wall = emission + reflectance * irradiance / pi = 0.25 + 0.5 * 1.5 = 1.
TEST(RayTracing, SeesEmittedAndReflectedLight) {
  const TestScene scene = furnace(1, {3, 3, 3});
  FakeMachine machine(1);
  machine.begin(scene, Stage::ray_tracing, 64, 1.5F);
  EXPECT_EQ(trace(machine, scene, rays_at_random(scene, 1000)), 1000U);
  ASSERT_EQ(machine.pixels.size(), 500U);
  for (const auto& [pixel, value] : machine.pixels) {
    for (const std::int64_t v : value) EXPECT_NEAR(static_cast<double>(v) * 0x1p-20, 2.0, 1e-5);  // two rays each
  }
}

TEST(RayTracing, BacksEmitOnlyWhereAsked) {
  TestScene scene = furnace(1, {1, 1, 1});
  for (TestPolygon& p : scene.polygons) {
    std::swap(p.corner[1], p.corner[2]);  // fronts outside
  }
  for (const std::uint32_t both : {0U, 1U}) {
    scene.materials[0].emits_from_back = both;
    FakeMachine machine(1);
    machine.begin(scene, Stage::ray_tracing, 64, 1.5F);
    trace(machine, scene, rays_at_random(scene, 10));
    for (std::uint32_t p = 0; p < 5; ++p) EXPECT_EQ(machine.pixels[p][0], both == 1 ? 1 << 19 : 0);
  }
}

TEST(RayTracing, MirrorWeighsWhatItReflects) {
  TestScene scene = furnace(2, {2, 3, 4});
  // The wall x high (polygons 54..71 of 108) is a mirror.
  for (std::size_t i = 54; i < 72; ++i) {
    scene.polygons[i].material = 1;
    scene.polygons[i].sides = 0;
  }
  FakeMachine machine(2);
  machine.begin(scene, Stage::ray_tracing, 64, 1.5F);
  EXPECT_EQ(trace(machine, scene, {ray_from(scene, {0.3F, 0.4F, 0.5F}, {1, 0.45F, 0.55F}, 7)}), 1U);
  EXPECT_NEAR(static_cast<double>(machine.pixels.at(7)[1]) * 0x1p-20, 0.5, 1e-5);
  scene.least_weight = 0.6F;  // now it is not worth following
  FakeMachine other(2);
  other.begin(scene, Stage::ray_tracing, 64, 1.5F);
  EXPECT_EQ(trace(other, scene, {ray_from(scene, {0.3F, 0.4F, 0.5F}, {1, 0.45F, 0.55F}, 7)}), 1U);
  EXPECT_TRUE(other.pixels.empty());
}

// A ray that meets a surface which another PE keeps is shaded there and goes on from there: to the bit as where all
// have all, layers included.
TEST(RayTracing, KeptSurfacesShadeAlike) {
  TestScene scene = furnace(3, {3, 3, 3});
  scene.materials[0] = glossy_material(0.4F, 0.4F, 20);
  scene.materials[0].emission = {0.25F, 0.25F, 0.25F};
  for (std::size_t i = 54; i < 72; ++i) {
    scene.polygons[i].material = 1;
    scene.polygons[i].sides = 0;
  }
  scene.bounces = 4;
  scene.copy_all = true;
  scene.layers = protocol::plane_bit(protocol::Plane::irradiance) | protocol::plane_bit(protocol::Plane::elements) |
                 protocol::plane_bit(protocol::Plane::depth);
  FakeMachine all(3);
  all.begin(scene, Stage::ray_tracing, 64, 1.5F);
  EXPECT_EQ(trace(all, scene, rays_at_random(scene, 500)), 500U);
  scene.keep_surfaces = true;
  FakeMachine apart(3);
  apart.begin(scene, Stage::ray_tracing, 64, 1.5F);
  EXPECT_LT(apart.stores[0].irradiance.size(), all.stores[0].irradiance.size() / 2);
  EXPECT_EQ(trace(apart, scene, rays_at_random(scene, 500)), 500U);
  EXPECT_EQ(all.pixels, apart.pixels);
  EXPECT_EQ(all.layers, apart.layers);
}

/// Two glass balls in the furnace. Clear glass in uniform light is invisible: each way's weights add up to one.
TestScene furnace_with_glass(std::uint32_t pes, std::array<std::uint32_t, 3> cells) {
  TestScene s = furnace(pes, cells);
  s.bounces = 255;
  add_ball(s, {0.3F, 0.5F, 0.5F}, 0.22F, 8, 2, true);  // one behind the other: more than two branches would wait
  add_ball(s, {0.75F, 0.5F, 0.5F}, 0.22F, 8, 2, true);
  for (TestPolygon& p : s.polygons) {
    if (p.material == 2) p.sides = 0;
  }
  return s;
}

// Branches keep the mean: exactly as long as none is chosen by chance, on average when they are.
TEST(RayTracing, ClearGlassInUniformLightIsInvisible) {
  const TestScene scene = furnace_with_glass(1, {4, 4, 4});
  FakeMachine machine(1);
  machine.begin(scene, Stage::ray_tracing, 64, 1.5F);
  const auto rays = rays_at_random(scene, 4000);
  EXPECT_EQ(trace(machine, scene, rays), 4000U);
  double sum = 0;
  for (const auto& [pixel, value] : machine.pixels) sum += static_cast<double>(value[0]) * 0x1p-20;
  EXPECT_NEAR(sum / 4000, 1.0, 0.005);  // chance acts on what is left after two branches: below 0.2 % of deviation each
}

/// What a ray straight down sees of a glossy floor in the furnace, on the average. waiting: branches that it already
/// has, of no weight. With shadow rays vertex irradiance has none of the emitters' light.
double seen_of_glossy_floor(bool shadow_rays, std::uint8_t waiting) {
  TestScene scene = furnace(2, {2, 3, 4});
  scene.materials.push_back(glossy_material(0.3F, 0.5F, 2000));
  scene.materials.back().emission = {0.25F, 0.25F, 0.25F};
  for (std::size_t i = 72; i < 90; ++i) scene.polygons[i].material = 3;  // y low
  const auto add_emitters = [&](PeStores& stores) {
    for (std::uint32_t p = 0; shadow_rays && p < scene.polygons.size(); ++p) {  // all of one size: equal chances
      const auto until = static_cast<std::uint32_t>((std::uint64_t{p + 1} << 32U) / scene.polygons.size() - 1);
      const float area_over_chance = 6 / std::numbers::pi_v<float>;
      stores.emitters.push_back({scene.polygons[p].corner, {0.25F, 0.25F, 0.25F}, area_over_chance, until, p, 0});
    }
  };
  FakeMachine machine(2);
  machine.load(scene, Stage::ray_tracing, 64, shadow_rays ? 1.5F - 0.25F : 1.5F, add_emitters);
  for (std::uint16_t p = 0; p < 2; ++p) machine.message(p, protocol::MessageKind::begin);
  machine.run();
  constexpr std::uint32_t count = 4000;
  std::vector<RayRecord> rays;
  for (std::uint32_t i = 0; i < count; ++i) {
    RayRecord& ray = rays.emplace_back(ray_from(scene, {0.5F, 0.95F, 0.5F}, {0.5F, 0, 0.5F}, i));
    ray.pixel = 0;
    ray.sample = static_cast<std::uint16_t>(i);
    ray.waiting = waiting;
    for (protocol::Branch& branch : ray.branches) branch = {{0.1F, 0.1F, 0.1F}, {1, 0, 0}, {}, 0, 0, 0, 0, 0, {0, 0}};
  }
  EXPECT_EQ(trace(machine, scene, rays), count);
  return static_cast<double>(machine.pixels.at(0)[0]) * 0x1p-20 / count;
}

// It shows what it emits and reflects diffusely, 0.25 + 0.3 * 1.5, and of the walls' 1 what its lobe reflects.
TEST(RayTracing, AGlossySurfaceShowsBothOfItsParts) {
  constexpr double expected = 0.25 + 0.3 * 1.5 + 0.5 * 1.0;
  EXPECT_NEAR(seen_of_glossy_floor(false, 0), expected, 0.001);  // the lobe is 1.3 degrees wide
  EXPECT_NEAR(seen_of_glossy_floor(false, protocol::kMostBranches), expected, 0.001);
  // A sample's direct light, 0.075 on the average, and up to 0.5: below 0.002 of deviation in the mean.
  EXPECT_NEAR(seen_of_glossy_floor(true, 0), expected, 0.008);
  // No room for both ways: one of them by chance, twice.
  EXPECT_NEAR(seen_of_glossy_floor(true, protocol::kMostBranches), expected, 0.03);
}

TEST(RayTracing, SamePictureWhateverTheMachine) {
  const TestScene one = furnace_with_glass(1, {1, 1, 1});
  FakeMachine machine(1);
  machine.begin(one, Stage::ray_tracing, 64, 1.5F);
  trace(machine, one, rays_at_random(one, 2000));
  struct Machine {
    std::uint32_t pes;
    std::array<std::uint32_t, 3> cells;
    std::uint32_t slots;
  };
  for (const Machine& m : {Machine{1, {5, 4, 3}, 64}, Machine{4, {4, 4, 4}, 7}, Machine{7, {3, 8, 5}, 100}}) {
    const TestScene scene = furnace_with_glass(m.pes, m.cells);
    FakeMachine other(m.pes);
    other.begin(scene, Stage::ray_tracing, m.slots, 1.5F);
    EXPECT_EQ(trace(other, scene, rays_at_random(scene, 2000)), 2000U);
    EXPECT_EQ(other.pixels, machine.pixels) << m.pes << " PEs";
    EXPECT_GE(other.records_sent, m.pes > 1 ? 1000U : 0U);
    EXPECT_LE(other.largest_packet, protocol::records_per_packet(Stage::ray_tracing));
  }
}

// A record has room for two branches. A ray that needs a third, or whose second way weighs nothing, leaves the slot
// behind its own as it was.
TEST(RayTracing, BranchesStayInsideTheirRecord) {
  const TestScene scene = furnace_with_glass(1, {1, 1, 1});
  FakeMachine machine(1);
  machine.begin(scene, Stage::ray_tracing, 2, 1.5F);
  const protocol::Store slots = machine.stores[0].layout.record_slots;
  const std::vector<std::byte> behind(sizeof(RayRecord), std::byte{0xA5});
  for (const RayRecord& r : rays_at_random(scene, 500)) {
    machine.pes[0]->write(slots.address + sizeof(RayRecord), behind);
    trace(machine, scene, {r});
    const auto now = machine.pes[0]->at(slots.address + sizeof(RayRecord), sizeof(RayRecord));
    ASSERT_TRUE(std::equal(now.begin(), now.end(), behind.begin()));
  }
}

TEST(RayTracing, QuantaAreRoundedToNearest) {
  EXPECT_EQ(pe::to_quanta(0.0F), 0);
  EXPECT_EQ(pe::to_quanta(0.49F), 0);
  EXPECT_EQ(pe::to_quanta(0.5F), 1);
  EXPECT_EQ(pe::to_quanta(2.4F), 2);
  EXPECT_EQ(pe::to_quanta(-2.6F), -3);
  EXPECT_EQ(pe::to_quanta(1e-30F), 0);
  EXPECT_EQ(pe::to_quanta(16777217.0F), 16777216);
  EXPECT_EQ(pe::to_quanta(0x1.23456p40F), 0x12345600000);
  EXPECT_EQ(pe::to_quanta(0x1p55F), std::int64_t{1} << 55);
  EXPECT_EQ(pe::to_quanta(INFINITY), std::int64_t{1} << 56);
  EXPECT_EQ(pe::to_quanta(-INFINITY), -(std::int64_t{1} << 56));
}

}  // namespace
}  // namespace torolux::test
