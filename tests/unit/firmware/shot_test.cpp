// SPDX-License-Identifier: MIT
// Proves: a shot divides its flux exactly, its directions follow the cosine law (form factor of a square, against its
// closed form), and candidates are chosen and ordered as the protocol says.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "firmware/pe/hemicube.hpp"
#include "tests/unit/firmware/fake_machine.hpp"

namespace torolux::test {
namespace {

using protocol::ShotKind;

TEST(Hemicube, WeightsAddUpToExactlyOne) {
  for (const std::uint32_t n : {2U, 4U, 6U, 16U, 64U, 256U}) {
    const auto table = hemicube_table(n);
    std::uint64_t sum = 0;
    for (std::uint32_t p = 0; p < protocol::hemicube_pixels(n); ++p) sum += table[pe::hemicube_pixel(n, p).weight];
    EXPECT_EQ(sum, protocol::kOne) << n;
  }
}

// Every direction is on its own side of the surface, and the pixel's weight is its delta form factor there.
TEST(Hemicube, PixelsLieWhereTheirWeightsSay) {
  const std::uint32_t n = 32;
  const auto table = hemicube_table(n);
  for (std::uint32_t p = 0; p < protocol::hemicube_pixels(n); ++p) {
    const pe::HemicubePixel at = pe::hemicube_pixel(n, p);
    ASSERT_GT(at.z, 0.0F);
    ASSERT_EQ(std::max({std::abs(at.x), std::abs(at.y), at.z}), 1.0F);
    const double r2 = static_cast<double>(at.x * at.x + at.y * at.y + at.z * at.z);
    const double area = 4.0 / (n * n);  // cos * cos' / (pi r^2) * area at the centre, cos' = 1 / r on any face
    const double mid = static_cast<double>(at.z) * area / (std::numbers::pi * r2 * r2);
    ASSERT_NEAR(table[at.weight] * 0x1p-32, mid, 0.004 * mid + 1e-9) << p;  // mid-point rule, N = 32: below 0.3 %
  }
}

// Parallel unit squares at distance 1, facing: from the centre of one, the closed form of the corner view factor, four
// times: F = 4 * (1/2pi) * (...) with half edges 0.5 -> 0.2395. Averaged over spins.
TEST(Hemicube, DirectionsFollowTheCosineLaw) {
  const double x = 0.5, a = std::sqrt(1 + x * x);
  const double expected = 4 / (2 * std::numbers::pi) * 2 * (x / a * std::atan(x / a));
  const std::uint32_t n = 32;
  const auto table = hemicube_table(n);
  std::mt19937 random(1);
  double sum = 0;
  const int spins = 64;
  for (int s = 0; s < spins; ++s) {
    const pe::Frame frame = pe::spun({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, static_cast<float>(random() >> 8U) * 0x1p-24F);
    for (std::uint32_t p = 0; p < protocol::hemicube_pixels(n); ++p) {
      const pe::HemicubePixel pixel = pe::hemicube_pixel(n, p);
      const glm::vec3 d = pe::pixel_direction(frame, pixel);
      ASSERT_NEAR(glm::length(d), 1.0F, 2e-7F);
      ASSERT_GT(d.z, 0.0F);
      if (std::abs(d.x / d.z) < 0.5F && std::abs(d.y / d.z) < 0.5F) sum += table[pixel.weight] * 0x1p-32;
    }
  }
  EXPECT_NEAR(sum / spins, expected, 0.005 * expected);  // 64 spins of 32 pixels: some 0.1 % of noise
}

TEST(Hemicube, SpinTurnsByTheAngleGiven) {
  for (const float turn : {0.0F, 0.25F, 0.5F, 0.99F}) {
    const pe::Frame f = pe::spun({{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, turn);
    const double angle = (static_cast<double>(turn) - 0.5) * std::numbers::pi / 2;
    EXPECT_NEAR(f.x.x, std::cos(angle), 1e-7);
    EXPECT_NEAR(f.x.y, std::sin(angle), 1e-7);
    EXPECT_NEAR(f.y.x, -std::sin(angle), 1e-7);
  }
}

// The k * k points are the centroids of equal triangles: inside, all different, their mean the patch's centre.
TEST(Hemicube, PointsOfAPatchAreStratified) {
  for (std::uint32_t k = 1; k <= 6; ++k) {
    double a = 0, b = 0;
    std::vector<std::pair<int, int>> seen;
    for (std::uint32_t p = 0; p < k * k; ++p) {
      const pe::PatchPoint at = pe::patch_point(k, p);
      ASSERT_GT(at.a, 0.0F);
      ASSERT_GT(at.b, 0.0F);
      ASSERT_LT(at.a + at.b, 1.0F);
      seen.emplace_back(std::lround(at.a * 3.0F * static_cast<float>(k)),
                        std::lround(at.b * 3.0F * static_cast<float>(k)));
      a += static_cast<double>(at.a);
      b += static_cast<double>(at.b);
    }
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(std::unique(seen.begin(), seen.end()), seen.end());
    EXPECT_NEAR(a / (k * k), 1.0 / 3, 1e-6);
    EXPECT_NEAR(b / (k * k), 1.0 / 3, 1e-6);
  }
}

/// One lamp triangle in a black room that takes everything.
TestScene lamp_in_room(std::uint32_t points) {
  TestScene s;
  s.points = points;
  s.hemicube_size = 6;
  s.materials = {diffuse_material(0.5F), diffuse_material(0.25F, 1)};
  add_room(s, {0, 0, 0}, {1, 1, 1}, 1, 0);
  s.polygons.push_back({{{{0.4F, 0.4F, 0.5F}, {0.6F, 0.4F, 0.5F}, {0.4F, 0.6F, 0.5F}}}, 1, 3, 1, 1});
  return s;
}

FakeMachine& begin_with(FakeMachine& machine, const TestScene& scene, const protocol::Flux& incident,
                        const protocol::Flux& emission) {
  machine.load(scene, protocol::Stage::radiosity, 64, 1, [&](PeStores& stores) {
    for (auto& side : stores.sides) {
      side.incident = incident;
      side.emission = emission;
    }
  });
  machine.message(0, protocol::MessageKind::begin);
  machine.run();
  return machine;
}

protocol::Flux incident_sum(const FakeMachine& machine) {
  protocol::Flux sum{};
  for (const auto& side : machine.store<protocol::PatchSide>(0, machine.stores[0].layout.patch_sides)) {
    for (std::size_t c = 0; c < 3; ++c) sum[c] += side.incident[c];
  }
  return sum;
}

// Awkward amounts (primes, one quantum, more pixels than quanta): what lands is what was shot, to the quantum.
TEST(Shot, DividesItsFluxExactly) {
  for (const std::uint32_t points : {1U, 2U, 3U}) {
    for (const protocol::Flux& amount :
         {protocol::Flux{1, 0, 7}, {1'000'003, 99, 2}, {(1LL << 47) + 12345, 1LL << 40, 3}}) {
      FakeMachine machine(1);
      begin_with(machine, lamp_in_room(points), {0, 0, 0}, amount);
      const auto patch = static_cast<std::uint32_t>(machine.stores[0].patches.size() - 1);
      const std::uint32_t records = machine.shoot(0, {amount, patch, 0, ShotKind::emitted, 0}, 13);
      EXPECT_EQ(incident_sum(machine), amount);
      EXPECT_LE(records, points * points * protocol::hemicube_pixels(6));
      const auto sides = machine.store<protocol::PatchSide>(0, machine.stores[0].layout.patch_sides);
      EXPECT_EQ(sides[machine.stores[0].patches[patch].side[0]].emission, (protocol::Flux{0, 0, 0}));
      EXPECT_EQ(sides[machine.stores[0].patches[patch].side[1]].emission, amount) << "the other side keeps its own";
    }
  }
}

// A reflected shot takes `amount` and carries that times the reflectance; from the back it goes to the other half.
TEST(Shot, ReflectsOnItsOwnSide) {
  FakeMachine machine(1);
  begin_with(machine, lamp_in_room(1), {1'000'000, 500, 3}, {0, 0, 0});
  const protocol::Flux before = incident_sum(machine);
  const auto patch = static_cast<std::uint32_t>(machine.stores[0].patches.size() - 1);
  machine.shoot(0, {{800'000, 400, 3}, patch, 1, ShotKind::reflected, 5});
  const protocol::Flux after = incident_sum(machine);
  EXPECT_EQ(after[0] - before[0], 200'000);
  EXPECT_EQ(after[1] - before[1], 100);
  EXPECT_EQ(after[2] - before[2], 0);
  const auto sides = machine.store<protocol::PatchSide>(0, machine.stores[0].layout.patch_sides);
  EXPECT_EQ(sides[machine.stores[0].patches[patch].side[1]].shot, (protocol::Flux{800'000, 400, 3}));
  // z high (polygons 2, 3) is in front of the lamp, z low (0, 1) behind it.
  EXPECT_GT(sides[machine.stores[0].patches[0].side[0]].incident[0], 1'000'000);
  EXPECT_EQ(sides[machine.stores[0].patches[2].side[0]].incident[0], 1'000'000);
}

TEST(Select, BestFirstTiesByNumberSideAndKind) {
  FakeMachine machine(1);
  TestScene scene = lamp_in_room(1);
  machine.load(scene, protocol::Stage::radiosity, 64, 1, [&](PeStores& stores) {
    std::mt19937 random(3);
    for (auto& side : stores.sides) {
      for (std::size_t c = 0; c < 3; ++c) {
        side.incident[c] = 100 * (random() % 4);
        side.shot[c] = side.incident[c] / 2;
        side.emission[c] = 25 * (random() % 4);
      }
    }
    stores.patches[0].number = 1'000;  // the order of numbers is not that of the store
  });
  machine.message(0, protocol::MessageKind::begin);
  machine.run();
  const auto all = machine.select(0, protocol::kMostShooters, 0);
  EXPECT_GT(all.size(), 25U) << "needs more than one message";
  const auto key = [](const protocol::Candidate& c) {
    return std::tuple(-c.unshot, c.number, c.side, c.kind == ShotKind::emitted ? 0 : 1);
  };
  for (std::size_t i = 1; i < all.size(); ++i) EXPECT_LT(key(all[i - 1]), key(all[i]));
  const auto& stores = machine.stores[0];
  for (const protocol::Candidate& c : all) {
    const auto& patch = stores.patches[c.patch];
    const auto& side = stores.sides[patch.side[c.side]];
    const auto& m = stores.materials[stores.polygons[patch.polygon].material];
    EXPECT_EQ(c.number, patch.number);
    std::int64_t unshot = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t amount = c.kind == ShotKind::emitted ? side.emission[k] : side.incident[k] - side.shot[k];
      EXPECT_EQ(c.amount[k], amount);
      unshot += c.kind == ShotKind::emitted ? amount : protocol::scale_down(amount, m.diffuse_fraction[k]);
    }
    EXPECT_EQ(c.unshot, unshot);
  }
  for (const std::uint32_t count : {1U, 5U, 20U, 21U}) {
    const auto best = machine.select(0, count, 0);
    ASSERT_EQ(best.size(), count);
    for (std::size_t i = 0; i < count; ++i) EXPECT_EQ(key(best[i]), key(all[i]));
  }
  const auto some = machine.select(0, protocol::kMostShooters, all[4].unshot);
  EXPECT_TRUE(std::all_of(some.begin(), some.end(), [&](const auto& c) { return c.unshot > all[4].unshot; }));
  EXPECT_TRUE(machine.select(0, 10, std::int64_t{1} << 50).empty());
  const auto last = [&] {
    machine.message(0, protocol::MessageKind::select, protocol::Select{1, 0, 0});
    machine.run();
    return machine.take(protocol::MessageKind::candidates).at(0).as<protocol::Candidates>();
  }();
  std::int64_t whole = 0;
  for (const auto& c : all) whole += c.unshot;
  EXPECT_EQ(last.unshot[0] + last.unshot[1] + last.unshot[2], whole);
}

}  // namespace
}  // namespace torolux::test
