// SPDX-License-Identifier: MIT
// Proves: a shot divides its flux exactly, its directions follow the cosine law (form factor of a square, against its
// closed form), and candidates are chosen and ordered as the protocol says.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <random>

#include "firmware/pe/hemicube.hpp"
#include "firmware/pe/shot_points.hpp"
#include "firmware/protocol/random.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "tests/unit/firmware/pe/fake_machine.hpp"

namespace torolux::test {
namespace {

using protocol::ShotKind;

TEST(Hemicube, WeightsAddUpToExactlyOne) {
  for (const std::uint32_t n : {2U, 4U, 6U, 16U, 64U, 256U}) {
    const auto table = hemicube_table(n);
    std::uint64_t sum = 0;
    for (std::uint32_t p = 0; p < protocol::hemicube_pixels(n); ++p)
      sum += table[pe::entry_of(n, pe::hemicube_pixel(pe::HemicubeGrid(n), p))].weight;
    EXPECT_EQ(sum, protocol::kOne) << n;
  }
}

/// The place on the cube of half-width 1 that a direction in the frame x, y, z goes through.
glm::vec3 on_cube(const glm::vec3& d) {
  return d * (1.0F / std::max({std::abs(d.x), std::abs(d.y), d.z}));
}
constexpr pe::Frame kAxes{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};

glm::vec3 direction(const std::vector<protocol::HemicubeEntry>& table, std::uint32_t n, const pe::HemicubePixel& pixel,
                    pe::PixelPoint at) {
  return pe::pixel_direction(kAxes, pe::HemicubeGrid(n), pixel, table[pe::entry_of(n, pixel)], at);
}

// Every direction is on its own side of the surface, and the pixel's weight is its delta form factor there.
TEST(Hemicube, PixelsLieWhereTheirWeightsSay) {
  const std::uint32_t n = 32;
  const pe::HemicubeGrid grid(n);
  const auto table = hemicube_table(n);
  for (std::uint32_t p = 0; p < protocol::hemicube_pixels(n); ++p) {
    const pe::HemicubePixel pixel = pe::hemicube_pixel(grid, p);
    const glm::vec3 at = on_cube(direction(table, n, pixel, {}));
    ASSERT_GT(at.z, 0.0F);
    const double r2 = static_cast<double>(glm::dot(at, at));
    const double area = 4.0 / (n * n);  // cos * cos' / (pi r^2) * area at a point, cos' = 1 / r on any face
    const double mid = static_cast<double>(at.z) * area / (std::numbers::pi * r2 * r2);
    // At the half of its light in either direction, which for a pixel at a side's foot is off its middle.
    const bool foot = pixel.face != pe::HemicubePixel::kTop && pixel.row == 0;
    ASSERT_NEAR(table[pe::entry_of(n, pixel)].weight * 0x1p-32, mid, (foot ? 0.45 : 0.06) * mid + 1e-9) << p;
  }
}

// Light goes through a pixel as its delta form factor is spread there, not evenly: else a coarse hemi-cube sends too
// much along the surface. Of a bottom pixel's light a quarter leaves below half its height (its density rises from the
// surface like z).
TEST(Hemicube, LightIsSpreadOverAPixelAsItsFormFactor) {
  const std::uint32_t n = 8;
  const auto table = hemicube_table(n);
  std::mt19937 random(5);
  const auto uniform = [&] { return static_cast<float>(random() >> 8U) * 0x1p-24F; };
  int low = 0;
  int top_inner = 0;
  constexpr int kDraws = 20'000;
  for (int i = 0; i < kDraws; ++i) {
    const glm::vec3 side = on_cube(direction(table, n, {0, 0, 3}, {uniform(), uniform()}));
    ASSERT_NEAR(side.x, 1.0F, 1e-6F);
    ASSERT_GE(side.y, -0.25F - 1e-6F);
    ASSERT_LE(side.y, 1e-6F);
    low += side.z < 0.125F ? 1 : 0;
    const glm::vec3 top = on_cube(direction(table, n, {pe::HemicubePixel::kTop, 7, 7}, {uniform(), uniform()}));
    ASSERT_GE(top.x, 0.75F - 1e-6F);
    top_inner += top.x < 0.875F ? 1 : 0;
  }
  // Standard deviation of a share of 20,000 draws: below 0.36 %.
  EXPECT_NEAR(static_cast<double>(low) / kDraws, 0.25, 0.02);
  // (1 + x^2 + y^2)^-2 over the corner pixel, integrated by hand over both halves: 0.541.
  EXPECT_NEAR(static_cast<double>(top_inner) / kDraws, 0.541, 0.015);
}

// Parallel unit squares at distance 1, facing: from the centre of one, the closed form of the corner view factor, four
// times: F = 4 * (1/2pi) * (...) with half edges 0.5 -> 0.2395. Averaged over spins.
// The middle of a large pixel gets what is its own: a density as straight as a line from edge to edge gives it 5 %
// less.
TEST(Hemicube, LightFollowsTheBendAcrossALargePixel) {
  const auto is_middle = [](double v) { return v >= 0.125 && v < 0.375; };
  constexpr int kSteps = 400;
  const auto table = hemicube_table(4);
  double all = 0;
  double middle = 0;
  int drawn = 0;
  for (int i = 0; i < kSteps * kSteps; ++i) {
    const int column = i % kSteps;
    const int row = i / kSteps;
    const double a = (column + 0.5) / kSteps;
    const double b = (row + 0.5) / kSteps;
    const double density = std::pow(1 + (a * a + b * b) / 4, -2);
    all += density;
    if (is_middle(a / 2) && is_middle(b / 2)) middle += density;
    const glm::vec3 at =
        on_cube(direction(table, 4, {pe::HemicubePixel::kTop, 2, 2}, {static_cast<float>(a), static_cast<float>(b)}));
    if (is_middle(static_cast<double>(at.x)) && is_middle(static_cast<double>(at.y))) ++drawn;
  }
  EXPECT_NEAR(drawn / double{kSteps * kSteps} / (middle / all), 1, 0.01) << "what is left is the bend's own error";
}

TEST(Hemicube, DirectionsFollowTheCosineLaw) {
  const double x = 0.5, a = std::sqrt(1 + x * x);
  const double expected = 4 / (2 * std::numbers::pi) * 2 * (x / a * std::atan(x / a));
  const std::uint32_t n = 32;
  const pe::HemicubeGrid grid(n);
  const auto table = hemicube_table(n);
  std::mt19937 random(1);
  double sum = 0;
  const int spins = 64;
  for (int s = 0; s < spins; ++s) {
    const pe::Frame frame = pe::spun(kAxes, static_cast<float>(random() >> 8U) * 0x1p-24F);
    for (std::uint32_t p = 0; p < protocol::hemicube_pixels(n); ++p) {
      const pe::HemicubePixel pixel = pe::hemicube_pixel(grid, p);
      const glm::vec3 d = pe::pixel_direction(frame, grid, pixel, table[pe::entry_of(n, pixel)], {});
      ASSERT_NEAR(glm::length(d), 1.0F, 2e-7F);
      ASSERT_GT(d.z, 0.0F);
      if (std::abs(d.x / d.z) < 0.5F && std::abs(d.y / d.z) < 0.5F)
        sum += table[pe::entry_of(n, pixel)].weight * 0x1p-32;
    }
  }
  EXPECT_NEAR(sum / spins, expected, 0.005 * expected);  // 64 spins of 32 pixels: some 0.1 % of noise
}

TEST(Hemicube, SpinTurnsByTheAngleGiven) {
  for (const float turn : {0.0F, 0.25F, 0.5F, 0.99F}) {
    const pe::Frame f = pe::spun(kAxes, turn);
    const double angle = (static_cast<double>(turn) - 0.5) * std::numbers::pi / 2;
    EXPECT_NEAR(f.x.x, std::cos(angle), 1e-7);
    EXPECT_NEAR(f.x.y, std::sin(angle), 1e-7);
    EXPECT_NEAR(f.y.x, -std::sin(angle), 1e-7);
  }
}

/// A patch of four elements, whose unshot flux is given, and its shot of k * k points.
struct PointsOfAPatch {
  TestScene scene;
  std::vector<PeStores> stores;
  pe::Scene view;
  pe::Shot shot;

  PointsOfAPatch(std::uint32_t k, const std::array<protocol::Vec3f, 4>& unshot, protocol::ShotKind kind) {
    scene.materials = {diffuse_material(0.5F)};
    scene.polygons.push_back({{{{0, 0, 0.5F}, {1, 0, 0.5F}, {0, 1, 0.5F}}}, 0, 1, 0, 1});
    stores = build_stores(scene, protocol::Stage::radiosity);
    view = stores[0].scene();
    for (std::size_t e = 0; e < 4; ++e) view.elements[e].shots.unshot = unshot[e];
    shot.command.kind = kind;
    shot.flux = {1'000'003, 600'011, 7};
    shot.points = k * k;
    shot.key = 77;
    pe::begin_points(view, shot);
  }

  protocol::PointRecord next() { return pe::make_point(view, shot, 0); }
  static protocol::Weights weights(const protocol::PointRecord& point) {
    return {1.0F - point.origin[0] - point.origin[1], point.origin[0], point.origin[1]};
  }
  /// Which element the point lies on.
  static std::uint32_t element(const protocol::PointRecord& point) {
    protocol::Weights at = weights(point);
    return protocol::enter_level(at, 1);
  }
};

// Emitted light leaves evenly: with k a power of two each of the k * k equal triangles gets one point.
TEST(ShotPoints, EmittedLightLeavesFromEqualParts) {
  for (const std::uint32_t k : {1U, 2U, 4U, 8U}) {
    PointsOfAPatch points(k, {}, protocol::ShotKind::emitted);
    std::vector<std::uint32_t> seen;
    protocol::Flux sum{};
    for (std::uint32_t p = 0; p < k * k; ++p) {
      const protocol::PointRecord point = points.next();
      protocol::Weights at = PointsOfAPatch::weights(point);
      ASSERT_GT(std::min({at.b0, at.b1, at.b2}), 0.0F);
      seen.push_back(protocol::enter_level(at, static_cast<std::uint32_t>(std::bit_width(k)) - 1U));
      for (std::size_t c = 0; c < 3; ++c) sum[c] += point.flux[c];
      EXPECT_NEAR(static_cast<double>(point.flux[0]), 1'000'003.0 / (k * k), 2.0);
    }
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(std::unique(seen.begin(), seen.end()), seen.end()) << k;
    EXPECT_EQ(sum, points.shot.flux);
  }
}

// Reflected light leaves where it came, in each channel its own share; the shares add up to the quantum.
TEST(ShotPoints, ReflectedLightLeavesWhereItCame) {
  // Red came to element 0, three times as much green to element 2, nothing to the others.
  PointsOfAPatch points(8, {{{10, 0, 0}, {0, 0, 0}, {0, 30, 0}, {0, 0, 0}}}, protocol::ShotKind::reflected);
  std::array<protocol::Flux, 4> by_element{};
  protocol::Flux sum{};
  std::array<int, 4> count{};
  for (std::uint32_t p = 0; p < 64; ++p) {
    const protocol::PointRecord point = points.next();
    const std::uint32_t element = PointsOfAPatch::element(point);
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_GE(point.flux[c], 0);
      by_element[element][c] += point.flux[c];
      sum[c] += point.flux[c];
    }
    ++count[element];
  }
  EXPECT_EQ(sum, points.shot.flux);
  EXPECT_EQ(count, (std::array{16, 0, 48, 0}));
  EXPECT_EQ(by_element[0][0], 1'000'003);
  EXPECT_EQ(by_element[2][1], 600'011);
  // Once shot, it is not shot again; what comes later is.
  EXPECT_EQ(points.view.elements[2].shots.shot, (protocol::Vec3f{0, 30, 0}));
}

// So little that it is lost in rounding: it leaves from anywhere, and not a quantum is lost.
TEST(ShotPoints, WhatNoElementKnowsOfLeavesByArea) {
  PointsOfAPatch points(3, {}, protocol::ShotKind::reflected);
  protocol::Flux sum{};
  for (std::uint32_t p = 0; p < 9; ++p) {
    const protocol::PointRecord point = points.next();
    for (std::size_t c = 0; c < 3; ++c) sum[c] += point.flux[c];
  }
  EXPECT_EQ(sum, points.shot.flux);
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

// From points close together, a shot is one hemi-cube with as many times the pixels as it has points: what a far
// polygon gets of it hardly depends on chance.
TEST(Shot, PointsShareOutThePixels) {
  TestScene scene = lamp_in_room(16);
  scene.polygons.back().corner = {{{0.5F, 0.5F, 0.5F}, {0.501F, 0.5F, 0.5F}, {0.5F, 0.501F, 0.5F}}};
  constexpr std::int64_t kAmount = 1LL << 40;
  constexpr std::uint32_t kShots = 16;
  double sum = 0;
  double squares = 0;
  for (std::uint32_t number = 0; number < kShots; ++number) {
    FakeMachine machine(1);
    begin_with(machine, scene, {0, 0, 0}, {kAmount, 0, 0});
    const auto patch = static_cast<std::uint32_t>(machine.stores[0].patches.size() - 1);
    machine.shoot(0, {{kAmount, 0, 0}, patch, 0, ShotKind::emitted, number});
    const auto sides = machine.store<protocol::PatchSide>(0, machine.stores[0].layout.patch_sides);
    const double got = static_cast<double>(sides[machine.stores[0].patches[2].side[0]].incident[0]) / kAmount;
    sum += got / kShots;
    squares += got * got / kShots;
  }
  EXPECT_GT(sum, 0.1);
  // Seen: 0.0013 of what it gets; where each point draws its place in a pixel for itself, 0.0065.
  EXPECT_LT(std::sqrt(squares - sum * sum), 0.003 * sum);
}

// Light reflected by a quarter: as many points as its greatest channel is worth, a whole grid, no more than asked for.
TEST(Shot, LittleLightLeavesFromFewPoints) {
  struct Case {
    std::int64_t amount;
    std::uint32_t grid;
  };
  for (const Case& shot : {Case{160'000, 1}, {800'000, 2}, {1'600'000, 2}, {1'640'000, 3}, {1LL << 40, 4}}) {
    TestScene scene = lamp_in_room(4);
    scene.points_per_quantum = 1e-5F;
    FakeMachine machine(1);
    begin_with(machine, scene, {1LL << 41, 1LL << 41, 1LL << 41}, {0, 0, 0});
    const auto patch = static_cast<std::uint32_t>(machine.stores[0].patches.size() - 1);
    const std::uint32_t records = machine.shoot(0, {{7, shot.amount, 0}, patch, 0, ShotKind::reflected, 0});
    EXPECT_EQ(records, shot.grid * shot.grid * protocol::hemicube_pixels(6)) << shot.amount;
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
    EXPECT_EQ(c.number, patch.number);
    std::int64_t unshot = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::int64_t amount = c.kind == ShotKind::emitted ? side.emission[k] : side.incident[k] - side.shot[k];
      EXPECT_EQ(c.amount[k], amount);
      unshot += c.kind == ShotKind::emitted ? amount : protocol::scale_down(amount, patch.reflectance[k]);
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
