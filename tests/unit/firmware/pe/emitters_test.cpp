// SPDX-License-Identifier: MIT
// Proves: the light that samples of emitters bring has the mean that theory says, comes from fronts only, and each
// emitter is chosen as often as its chance says; with whole PEs: what a shadow ray adds to its pixel, what casts a
// shadow, nothing counted twice, the same bits for any number of PEs.
#include "firmware/pe/emitters.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/unit/firmware/pe/fake_machine.hpp"

namespace torolux::test {
namespace {

using protocol::RayRecord;
using protocol::Stage;
using protocol::stratified_triple;

/// A square lamp of edge 0.4 that hangs, facing down, 0.5 above the point (0.5, 0.5, 0.1), and is two polygons.
TestScene lamp(float emission) {
  TestScene s;
  s.materials = {diffuse_material(0.5F), diffuse_material(0.0F, emission)};
  add_wall(s, {0.3F, 0.3F, 0.6F}, {0, 0.4F, 0}, {0.4F, 0, 0}, 1, 1);
  aim_at(s, 1);
  return s;
}

struct Brought {
  glm::vec3 mean{0.0F};
  std::uint32_t found = 0;
};

Brought brought(const TestScene& scene, const glm::vec3& point, const glm::vec3& normal, std::uint32_t samples) {
  PeStores stores = build_stores(scene, Stage::ray_tracing)[0];
  const pe::Scene at_pe = stores.scene();
  Brought sum;
  for (std::uint32_t s = 0; s < samples; ++s) {
    pe::EmitterSample sample{};
    if (!pe::sample_emitter(at_pe, stratified_triple(s, 9), point, normal, normal, sample)) continue;
    sum.mean += sample.irradiance_over_pi * (1.0F / static_cast<float>(samples));
    ++sum.found;
  }
  return sum;
}

/// Form factor from a point to a rectangle parallel to it, one corner right above it (Howell, Catalog of Radiation Heat
/// Transfer Configuration Factors, B-3): sides over distance.
double corner_factor(double x, double y) {
  const double a = std::sqrt(1 + x * x);
  const double b = std::sqrt(1 + y * y);
  return (x / a * std::atan(y / a) + y / b * std::atan(x / b)) / (2 * std::numbers::pi);
}

// Irradiance / pi = radiance * form factor. 4096 samples that keep apart: off by less than 0.1 %.
TEST(Emitters, MeanIsTheFormFactorTimesTheRadiance) {
  const double wanted = 3 * 4 * corner_factor(0.4, 0.4);
  EXPECT_NEAR(static_cast<double>(brought(lamp(3), {0.5F, 0.5F, 0.1F}, {0, 0, 1}, 4096).mean.y), wanted, 1e-3 * wanted);
  // Under a corner of it, and turned: of the upright half space only what is in front of the point's side counts.
  const double beside = 3 * corner_factor(0.8, 0.8);
  EXPECT_NEAR(static_cast<double>(brought(lamp(3), {0.3F, 0.3F, 0.1F}, {0, 0, 1}, 4096).mean.y), beside, 1e-3 * beside);
}

TEST(Emitters, AnUnequalChanceChangesNoMean) {
  TestScene scene = lamp(3);
  scene.emitters[0].chosen_to = 0xE000'0000U;  // 7 of 8 instead of one half
  scene.emitters[0].area_over_chance *= 4.0F / 7.0F;
  scene.emitters[1].area_over_chance *= 4.0F;
  const double wanted = 3 * 4 * corner_factor(0.4, 0.4);
  EXPECT_NEAR(static_cast<double>(brought(scene, {0.5F, 0.5F, 0.1F}, {0, 0, 1}, 4096).mean.y), wanted, 2e-3 * wanted);
  PeStores stores = build_stores(scene, Stage::ray_tracing)[0];
  std::uint32_t first = 0;
  for (std::uint32_t s = 0; s < 4096; ++s) {
    pe::EmitterSample sample{};
    const glm::vec3 up{0, 0, 1};
    ASSERT_TRUE(pe::sample_emitter(stores.scene(), stratified_triple(s, 5), {0.5F, 0.5F, 0.1F}, up, up, sample));
    first += sample.polygon == 0 ? 1 : 0;
  }
  EXPECT_NEAR(first, 3584, 1) << "stratified, so no chance in it";
}

// A small lamp close by among large ones far away: it has a hundredth of the power and brings most of the light. The
// mean is still theory's, and few samples come near it: not once in a hundred all, and else nothing.
TEST(Emitters, ASmallLampNearbyIsNotLeftToLuck) {
  TestScene scene;
  scene.materials = {diffuse_material(0.5F), diffuse_material(0.0F, 3)};
  add_wall(scene, {0.45F, 0.45F, 0.2F}, {0, 0.1F, 0}, {0.1F, 0, 0}, 1, 1);
  for (const float x : {0.0F, 0.25F, 0.5F, 0.75F}) add_wall(scene, {x, 0, 1}, {0, 1, 0}, {0.25F, 0, 0}, 1, 1);
  aim_at(scene, 1);
  std::uint32_t polygon = 0;
  const float share = 0.01F / 1.01F;  // of the near lamp's area
  for (auto& emitter : scene.emitters) {
    const bool near = polygon < 2;
    const float chance = near ? share / 2 : (1 - share) / 8;
    const float upto =
        near ? share / 2 * static_cast<float>(polygon + 1) : share + chance * static_cast<float>(polygon - 1);
    emitter.chosen_to = polygon == 9 ? 0xFFFF'FFFFU : static_cast<std::uint32_t>(static_cast<double>(upto) * 0x1p32);
    emitter.area_over_chance = (near ? 0.005F : 0.125F) / (chance * std::numbers::pi_v<float>);
    ++polygon;
  }
  const double wanted = 3 * 4 * (corner_factor(0.5, 0.5) + corner_factor(0.5 / 0.9, 0.5 / 0.9));
  const double got = static_cast<double>(brought(scene, {0.5F, 0.5F, 0.1F}, {0, 0, 1}, 4096).mean.y);
  EXPECT_NEAR(got, wanted, 0.01 * wanted);
  PeStores stores = build_stores(scene, Stage::ray_tracing)[0];
  double squares = 0;
  for (std::uint32_t s = 0; s < 4096; ++s) {
    pe::EmitterSample sample{};
    const glm::vec3 up{0, 0, 1};
    ASSERT_TRUE(pe::sample_emitter(stores.scene(), stratified_triple(s, 5), {0.5F, 0.5F, 0.1F}, up, up, sample));
    const double off = static_cast<double>(sample.irradiance_over_pi.y) - wanted;
    squares += off * off / 4096;
  }
  EXPECT_LT(std::sqrt(squares), 2 * wanted) << "by power alone: 4.6 times";
}

// Four lamps that bring the same light: of 32 samples of a pixel each gets 8 or so. By chance the counts' variance
// would be 6. What is left comes of the candidates (7) on borders between lamps: now the one, now the other.
TEST(Emitters, SamplesOfAPixelShareOutTheLamps) {
  TestScene scene;
  scene.materials = {diffuse_material(0.5F), diffuse_material(0.0F, 3)};
  for (const float x : {0.1F, 0.7F}) {
    for (const float y : {0.1F, 0.7F}) add_wall(scene, {x, y, 1}, {0, 0.2F, 0}, {0.2F, 0, 0}, 1, 1);
  }
  aim_at(scene, 1);
  PeStores stores = build_stores(scene, Stage::ray_tracing)[0];
  const glm::vec3 up{0, 0, 1};
  double variance = 0;
  for (std::uint32_t pixel = 0; pixel < 50; ++pixel) {
    std::array<int, 4> chosen{};
    for (std::uint32_t s = 0; s < 32; ++s) {
      pe::EmitterSample sample{};
      ASSERT_TRUE(pe::sample_emitter(stores.scene(), stratified_triple(s, pixel), {0.5F, 0.5F, 0.1F}, up, up, sample));
      ++chosen[sample.polygon / 2];
    }
    for (const int count : chosen) variance += (count - 8) * (count - 8) / 200.0;
  }
  EXPECT_LT(variance, 2);
}

TEST(Emitters, LightComesFromFrontsToTheSideThatSeesThem) {
  TestScene scene = lamp(3);
  EXPECT_EQ(brought(scene, {0.5F, 0.5F, 0.9F}, {0, 0, -1}, 64).found, 0U) << "behind the lamp";
  EXPECT_EQ(brought(scene, {0.5F, 0.5F, 0.1F}, {0, 0, -1}, 64).found, 0U) << "away from the lamp";
  EXPECT_EQ(brought(scene, {0.5F, 0.5F, 0.6F}, {0, 0, -1}, 64).found, 0U) << "in its plane";
  for (protocol::Emitter& emitter : scene.emitters) emitter.both_sides = 1;
  const double wanted = 3 * 4 * corner_factor(0.2 / 0.3, 0.2 / 0.3);
  EXPECT_NEAR(static_cast<double>(brought(scene, {0.5F, 0.5F, 0.9F}, {0, 0, -1}, 4096).mean.y), wanted, 2e-3 * wanted);
}

/// Form factor from a point to a triangle before it (Lambert 1760): the edges' angles, each times the cosine of its
/// plane's normal.
double lambert_factor(const std::array<protocol::Vec3f, 3>& corner, const glm::vec3& point, const glm::vec3& normal) {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::dvec3 from = glm::normalize(glm::dvec3(pe::to_vector(corner[i]) - point));
    const glm::dvec3 to = glm::normalize(glm::dvec3(pe::to_vector(corner[(i + 1) % 3]) - point));
    const glm::dvec3 across = glm::cross(from, to);
    sum += std::atan2(glm::length(across), glm::dot(from, to)) * glm::dot(glm::normalize(across), glm::dvec3(normal));
  }
  return std::abs(sum) / (2 * std::numbers::pi);
}

// On a wall that the lamp touches, down to a thousandth of its size: the mean is theory's, and samples differ by no
// more than the cosine at the wall and the two halves of the lamp do (the far half brings less). By area one brings up
// to a thousand times the mean.
TEST(Emitters, NearALampSamplesBringAlike) {
  const TestScene scene = lamp(3);
  PeStores stores = build_stores(scene, Stage::ray_tracing)[0];
  const glm::vec3 normal{1, 0, 0};  // of a wall along the lamp's edge
  for (const float below : {0.1F, 0.01F, 4e-4F}) {
    const glm::vec3 point{0.3F, 0.47F, 0.6F - below};
    double wanted = 0;
    for (const protocol::Emitter& emitter : scene.emitters) wanted += 3 * lambert_factor(emitter.corner, point, normal);
    double mean = 0;
    double most = 0;
    for (std::uint32_t s = 0; s < 4096; ++s) {
      pe::EmitterSample sample{};
      if (!pe::sample_emitter(stores.scene(), stratified_triple(s, 5), point, normal, normal, sample)) continue;
      mean += static_cast<double>(sample.irradiance_over_pi.y) / 4096;
      most = std::max(most, static_cast<double>(sample.irradiance_over_pi.y));
    }
    EXPECT_NEAR(mean, wanted, 5e-3 * wanted) << below;
    EXPECT_LT(most, 6 * wanted) << below;
  }
}

// At any distance, in the lamp's plane too: no more than the half space before it, of an emitter chosen half the time.
TEST(Emitters, LightFromNearbyIsBounded) {
  const TestScene scene = lamp(1);
  PeStores stores = build_stores(scene, Stage::ray_tracing)[0];
  const glm::vec3 up{0, 0, 1};
  for (const float distance : {1e-3F, 1e-6F, 1e-20F}) {
    for (std::uint32_t s = 0; s < 64; ++s) {
      pe::EmitterSample sample{};
      if (!pe::sample_emitter(stores.scene(), stratified_triple(s, 9), {0.4F, 0.5F, 0.6F - distance}, up, up, sample))
        continue;
      EXPECT_LE(sample.irradiance_over_pi.x, 4.001F) << distance;
    }
  }
}

// Near an outline that normals only pretend to round off, no light comes through the flat polygon.
TEST(Emitters, LightDoesNotComeThroughTheFlatPolygon) {
  PeStores stores = build_stores(lamp(1), Stage::ray_tracing)[0];
  const glm::vec3 point{0.5F, 0.5F, 0.1F};
  const glm::vec3 tilted = glm::normalize(glm::vec3(1.0F, 0.0F, 0.5F));
  pe::EmitterSample sample{};
  EXPECT_FALSE(pe::sample_emitter(stores.scene(), stratified_triple(1, 9), point, {0, 0, 1}, -tilted, sample));
  EXPECT_FALSE(pe::sample_emitter(stores.scene(), stratified_triple(1, 9), point, -tilted, {0, 0, 1}, sample));
}

RayRecord ray_to(const TestScene& scene, const glm::vec3& origin, const glm::vec3& target, std::uint32_t sample) {
  RayRecord r{};
  r.origin = pe::to_array(origin);
  r.direction = pe::to_array(glm::normalize(target - origin));
  r.weight = {1, 1, 1};
  r.place = scene.place_of(origin);
  r.polygon = protocol::kNoPolygon;
  r.key = sample;
  r.sample = static_cast<std::uint16_t>(sample);
  r.flags = protocol::kFirst;
  return r;
}

/// Mean of the pixel over so many rays from one place towards another, and that all their credits come home.
double seen(const TestScene& scene, const glm::vec3& origin, const glm::vec3& target, std::uint32_t samples,
            std::array<std::int64_t, 3>* sums = nullptr) {
  FakeMachine machine(scene.pes);
  machine.begin(scene, Stage::ray_tracing, 64, 0.25F);
  for (std::uint32_t s = 0; s < samples; ++s) {
    const RayRecord r = ray_to(scene, origin, target, s);
    const auto cell = scene.cell_of({origin.x, origin.y, origin.z});
    const auto* bytes = reinterpret_cast<const std::byte*>(&r);
    machine.send({protocol::kHost, scene.pe_of(cell[0], cell[1], cell[2]), {{bytes, bytes + sizeof(r)}}});
  }
  machine.run();
  EXPECT_EQ(machine.take_credits(), samples);
  if (sums != nullptr) *sums = machine.pixels[0];
  return static_cast<double>(machine.pixels[0][1]) * 0x1p-20 / samples;
}

/// A room with reflectance 0.5 and that lamp. VertexIrradiance values (0.25) stand for light that came by way of other
/// surfaces.
TestScene lit_room(std::uint32_t pes = 1, std::array<std::uint32_t, 3> cells = {1, 1, 1}) {
  TestScene s;
  s.pes = pes;
  s.cells = cells;
  s.materials = {diffuse_material(0.5F), diffuse_material(0.0F, 3), mirror_material(0.5F), glass_material(1.5F)};
  add_room(s, {0, 0, 0}, {1, 1, 1}, 2, 0);
  add_wall(s, {0.3F, 0.3F, 0.6F}, {0, 0.4F, 0}, {0.4F, 0, 0}, 1, 1);
  aim_at(s, 1);
  return s;
}

constexpr glm::vec3 kEye{0.1F, 0.1F, 0.3F};
constexpr glm::vec3 kUnderLamp{0.5F, 0.5F, 0.0F};
/// What the floor under the lamp shows: emitter light and interpolated light, times the reflectance.
const double kDirect = 0.5 * 3 * 4 * corner_factor(0.2 / 0.6, 0.2 / 0.6);
constexpr double kIndirect = 0.5 * 0.25;

TEST(ShadowRays, BringWhatTheLampSends) {
  EXPECT_NEAR(seen(lit_room(), kEye, kUnderLamp, 1024), kDirect + kIndirect, 2e-3);
  // One ray per hit: none at all where nothing is asked for.
  TestScene without = lit_room();
  without.emitters.clear();
  EXPECT_NEAR(seen(without, kEye, kUnderLamp, 16), kIndirect, 1e-6);
}

TEST(ShadowRays, WhatStandsBeforeTheLampTakesItsLight) {
  for (const std::uint16_t material :
       std::initializer_list<std::uint16_t>{0, 2, 3}) {  // diffuse; mirror and glass likewise
    TestScene covered = lit_room();
    add_wall(covered, {0.2F, 0.2F, 0.55F}, {0, 0.6F, 0}, {0.6F, 0, 0}, 1, material);
    covered.polygons.back().sides = 0;
    covered.polygons[covered.polygons.size() - 2].sides = 0;
    EXPECT_NEAR(seen(covered, kEye, kUnderLamp, 64), kIndirect, 1e-6) << "material " << material;
  }
  TestScene glazed = lit_room();  // a pane takes what both of its faces reflect, and what it absorbs
  glazed.materials.push_back(pane_material(1.5F, 0.5F));
  add_wall(glazed, {0.2F, 0.2F, 0.55F}, {0, 0.6F, 0}, {0.6F, 0, 0}, 1, 4);
  glazed.polygons.back().sides = glazed.polygons[glazed.polygons.size() - 2].sides = 0;
  // Light comes at up to 25 degrees, at which a face reflects 0.0405 of it.
  EXPECT_NEAR(seen(glazed, kEye, kUnderLamp, 1024), kDirect * 0.96 * 0.96 * 0.5 + kIndirect, 4e-3);
  TestScene half = lit_room();  // up to the middle
  add_wall(half, {0.0F, 0.2F, 0.3F}, {0, 0.6F, 0}, {0.5F, 0, 0}, 1, 0);
  EXPECT_NEAR(seen(half, {0.9F, 0.1F, 0.2F}, kUnderLamp, 1024), kDirect / 2 + kIndirect, 2e-3);
}

// Of panes in one plane each may be met behind the other without end: a shadow ray ends with the other segments.
TEST(ShadowRays, PassNoMorePanesThanThereAreBounces) {
  const auto behind = [](int panes, float apart) {
    TestScene glazed = lit_room();
    glazed.bounces = 4;
    glazed.materials.push_back(pane_material(1.5F, 1.0F));
    for (int i = 0; i < panes; ++i) {
      add_wall(glazed, {0.2F, 0.2F, 0.4F + apart * static_cast<float>(i)}, {0, 0.6F, 0}, {0.6F, 0, 0}, 1, 4);
      glazed.polygons.back().sides = glazed.polygons[glazed.polygons.size() - 2].sides = 0;
    }
    return seen(glazed, kEye, kUnderLamp, 256);
  };
  const double passed = 0.92;  // of light that comes straight
  EXPECT_NEAR(behind(3, 0.02F), kDirect * passed * passed * passed + kIndirect, 1e-2);
  EXPECT_NEAR(behind(4, 0.02F), kIndirect, 1e-6);
  EXPECT_LE(behind(2, 0), kDirect + kIndirect) << "in one plane: it ends, whichever is met";
}

// The lamp in view shows its radiance, seen straight or by way of the mirror, and no shadow ray adds to that.
TEST(ShadowRays, ALampInViewIsCountedOnce) {
  EXPECT_NEAR(seen(lit_room(), kEye, {0.5F, 0.45F, 0.6F}, 64), 3.0, 1e-5);
  TestScene mirrored = lit_room();
  for (TestPolygon& p : mirrored.polygons) {
    const bool floor = p.corner[0][2] == 0 && p.corner[1][2] == 0 && p.corner[2][2] == 0;
    if (!floor) continue;
    p.material = 2;
    p.sides = 0;
  }
  EXPECT_NEAR(seen(mirrored, {0.5F, 0.1F, 0.3F}, {0.5F, 0.25F, 0.0F}, 64), 0.5 * 3.0, 1e-5);
  // A diffuse wall by way of the mirror: its shadow ray is weighed by the mirror, too.
  const double straight = seen(mirrored, {0.5F, 0.5F, 0.2F}, {1.0F, 0.5F, 0.2F}, 1024);
  EXPECT_NEAR(seen(mirrored, {0.5F, 0.5F, 0.2F}, {0.75F, 0.5F, 0.0F}, 1024), 0.5 * straight, 2e-3);
}

// With the lamp behind the surface the path ends where it is: no light, no lost record.
TEST(ShadowRays, NothingIsSentWhereNoLightWouldCome) {
  EXPECT_NEAR(seen(lit_room(), kEye, {0.5F, 0.5F, 1.0F}, 16), kIndirect, 1e-6) << "the ceiling, behind the lamp";
}

// The least weight is one of paths. What a lamp sends far away, or to a dark surface, is weak against its own radiance,
// but may be all the light that there is.
TEST(ShadowRays, WeakLightCounts) {
  TestScene scene = lit_room();
  scene.least_weight = 0.9F;
  EXPECT_NEAR(seen(scene, kEye, kUnderLamp, 1024), kDirect + kIndirect, 2e-3);
}

TEST(ShadowRays, SameBitsWhateverTheMachine) {
  std::array<std::int64_t, 3> one{};
  seen(lit_room(), kEye, kUnderLamp, 200, &one);
  for (const auto& [pes, cells] : {std::pair{1U, std::array{4U, 3U, 5U}}, {4U, {4U, 4U, 4U}}, {7U, {3U, 8U, 5U}}}) {
    std::array<std::int64_t, 3> other{};
    seen(lit_room(pes, cells), kEye, kUnderLamp, 200, &other);
    EXPECT_EQ(other, one) << pes << " PEs";
  }
}

}  // namespace
}  // namespace torolux::test
