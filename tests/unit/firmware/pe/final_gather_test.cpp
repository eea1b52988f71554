// SPDX-License-Identifier: MIT
// Proves, with whole PEs and fake NIUs: elements find by final gathering what the surfaces around them give off; the
// sums are the same bits whatever the machine; and every point of a gathering is counted once, with rays or without.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <utility>
#include <vector>

#include "tests/unit/firmware/pe/gathering_room.hpp"
#include "tests/unit/firmware/pe/radiosity_room.hpp"

namespace torolux::test {
namespace {

using protocol::Element;
using protocol::Flux;
using protocol::kTurned;
using protocol::MessageKind;
using protocol::ShotKind;
using protocol::Stage;

/// found / points is so much of the element's own flux times the reflectance.
void expect_found(const Gathered& element, double part, double tolerance) {
  for (std::size_t c = 0; c < 3; ++c) {
    const double expected = part * static_cast<double>(kReflectance) * static_cast<double>(element.flux[c]);
    EXPECT_NEAR(static_cast<double>(element.found[c]) / element.points, expected, tolerance * expected);
  }
}

// All around is as bright: whatever a ray meets, it finds that, and each element what a closed room of this radiosity
// sends it, without noise. One PE, and several.
TEST(FinalGather, FindsWhatAnEvenlyLitRoomGivesOff) {
  for (const std::uint32_t pes : {1U, 5U}) {
    FakeMachine machine(pes);
    begin_evenly(machine, closed_room(pes, {3, 2, 2}), kAll);
    for (const auto& [place, elements] : gather_all(machine, 3)) {
      for (const Gathered& element : elements) {
        EXPECT_EQ(element.points, 3U);
        expect_found(element, 1, 1e-6);  // of floats, and of half a quantum for each ray
      }
    }
    machine.stop();
  }
}

/// An evenly bright ceiling, polygons 2 and 3 of a unit cube's.
TestScene cube() {
  TestScene scene;
  scene.apart = kTurned;
  scene.materials = {diffuse_material(kReflectance)};
  add_room(scene, {0, 0, 0}, {1, 1, 1}, 1, 0);
  for (TestPolygon& polygon : scene.polygons) polygon.element_level = 2;
  return scene;
}

constexpr auto kOfCeiling = [](std::uint32_t polygon) { return polygon == 2 || polygon == 3; };

/// Of the first channel, what the floor's elements find; the ceiling's find nothing.
double found_by_floor(FakeMachine& machine) {
  const GatheredBySide all = gather_all(machine, 8);
  double floor = 0;
  for (const std::uint32_t patch : {0U, 1U}) {
    for (const Gathered& e : all.at({patch, 0})) floor += static_cast<double>(e.found[0]) / e.points;
  }
  for (const std::uint32_t patch : {2U, 3U}) {
    for (const Gathered& e : all.at({patch, 0})) EXPECT_EQ(e.found, Flux{}) << "it does not see itself";
  }
  return floor;
}

// Directions follow the cosine: of the light of a cube's ceiling, its floor finds what the form factor between them
// says (0.19982, of parallel unit squares at distance 1).
TEST(FinalGather, FindsByTheFormFactor) {
  FakeMachine machine(1);
  begin_evenly(machine, cube(), kOfCeiling);
  const double expected = 0.19982 * static_cast<double>(kReflectance) * kEven[0];
  EXPECT_NEAR(found_by_floor(machine), expected, 0.01 * expected);  // 32 elements, each of 384 rays that keep apart
}

// Light that a ceiling emits is found likewise where rays are to look for it, and nowhere else.
TEST(FinalGather, FindsWhatLargeEmittersEmit) {
  for (const std::uint32_t gathers_emission : {0U, 1U}) {
    TestScene scene = cube();
    scene.gathers_emission = gathers_emission;
    FakeMachine machine(1);
    machine.load(scene, Stage::radiosity, 64, 1, [](PeStores& stores) {
      light_evenly(stores, [](std::uint32_t) { return false; });
      for (const protocol::Patch& patch : stores.patches) {
        if (kOfCeiling(stores.facets[patch.first_facet].polygon)) stores.sides[patch.side[0]].emits = {1e12F, 0, 0};
      }
    });
    machine.message(0, MessageKind::begin);
    machine.run();
    const double expected = gathers_emission * 0.19982e12;
    EXPECT_NEAR(found_by_floor(machine), expected, 0.01 * expected);  // as above
  }
}

struct Machine {
  std::uint32_t pes;
  std::array<std::uint32_t, 3> cells;
  std::uint32_t slots, credits;
  bool stop_everywhere, copy_all, points_travel;
  std::uint32_t open_batches, parts;
};

/// A room with mirror, glass and glossy floor, and a pane below the lamp, after some shots.
GatheredBySide gather_in_room(const Machine& m) {
  TestScene scene = room_with_balls(m.pes, m.cells);
  scene.apart = kTurned;
  scene.stop_everywhere = m.stop_everywhere;
  scene.copy_all = m.copy_all;
  scene.open_batches = m.open_batches;
  add_pane(scene);
  FakeMachine machine(m.pes);
  machine.points_travel = m.points_travel;
  machine.shoot_in_parts = m.parts;
  begin_room(machine, scene, m.slots);
  RoomOutcome shots;
  shoot_best(machine, 6, m.credits, shots);
  GatheredBySide out = gather_all(machine, 2, m.credits);
  machine.stop();
  return out;
}

// Found flux is added up in integers, and rays do not change when they are handed over: the machine makes no
// difference, to the quantum, nor whether points are dealt whole or in parts.
TEST(FinalGather, SameSumsWhateverTheMachine) {
  const GatheredBySide one = gather_in_room({1, {1, 1, 1}, 64, 1'000'000, false, false, true, 64, 1});
  std::int64_t found = 0;
  for (const auto& [place, elements] : one) {
    for (const Gathered& element : elements) found += element.found[0];
  }
  EXPECT_GT(found, kEmitted / 100);
  for (const Machine& m : {Machine{1, {5, 3, 4}, 64, 77, true, true, true, 64, protocol::kPointParts},
                           Machine{2, {2, 2, 2}, 64, 100, false, false, true, 2, protocol::kPointParts},
                           Machine{5, {4, 7, 3}, 200, 999, true, false, true, 8, 1},
                           Machine{12, {6, 6, 6}, 16, 300, false, true, true, 16, protocol::kPointParts},
                           Machine{7, {3, 9, 5}, 64, 64, false, false, false, 4, 1}}) {
    EXPECT_EQ(gather_in_room(m), one) << m.pes << " PEs";
  }
}

/// One polygon of 16 elements in a patch, in an otherwise dark room.
struct Wall {
  TestScene scene;
  FakeMachine machine{2};

  Wall() {
    scene = closed_room(2, {2, 2, 2});
    scene.polygons[0].patch_level = 0;
    scene.polygons[0].element_level = 2;
    machine.begin(scene, Stage::radiosity);
  }
  std::pair<std::uint16_t, std::uint32_t> place() const {
    const auto is_first = [](const protocol::Patch& patch) { return patch.number == 0; };
    const auto& patches = machine.stores[0].patches;
    const auto found = std::ranges::find_if(patches, is_first);
    if (found != patches.end()) return {std::uint16_t{0}, static_cast<std::uint32_t>(found - patches.begin())};
    const auto& others = machine.stores[1].patches;
    return {std::uint16_t{1}, static_cast<std::uint32_t>(std::ranges::find_if(others, is_first) - others.begin())};
  }
  std::vector<Gathered> gather(std::uint32_t points, std::uint32_t number) {
    const auto [pe, patch] = place();
    machine.shoot(pe, {{points, 0, 0}, patch, 0, ShotKind::gathering, number});
    return gathered_by(machine, pe, machine.stores[pe].patches[patch], 0);
  }
};

// Points are shared out evenly among elements of the same share: no element is left without where there are enough for
// all, whatever the random numbers.
TEST(FinalGather, EveryElementGetsItsPoints) {
  Wall wall;
  for (const std::uint32_t points : {1U, 7U, 16U, 17U, 24U, 31U, 32U, 100U, 1000U}) {
    for (std::uint32_t number = 0; number < 10; ++number) {
      std::uint32_t sum = 0;
      for (const Gathered& element : wall.gather(points, number)) {
        EXPECT_GE(element.points, points / 16) << points;
        EXPECT_LE(element.points, (points + 15) / 16) << points;
        sum += element.points;
      }
      EXPECT_EQ(sum, points);
    }
  }
}

// Where no light has come none would be found: no ray is made, yet all points are done and counted (shoot() waits for
// WorkDone to tell of them), dealt whole or in parts.
TEST(FinalGather, DarkSidesMakeNoRays) {
  for (const std::uint32_t parts : {1U, protocol::kPointParts}) {
    Wall wall;
    wall.machine.shoot_in_parts = parts;
    const auto [pe, patch] = wall.place();
    EXPECT_EQ(gather_side(wall.machine, pe, patch, 0, 100), 0U);
    EXPECT_EQ(gather_rays(wall.machine), 0U);
    std::uint32_t points = 0;
    for (const Gathered& element : gathered_by(wall.machine, pe, wall.machine.stores[pe].patches[patch], 0)) {
      EXPECT_EQ(element.found, Flux{});
      points += element.points;
    }
    EXPECT_EQ(points, 100U);
    wall.machine.stop();
  }
}

// A gathering takes no flux and is no shot: what stores and tally tell of shots stays. A second one of the side begins
// anew.
TEST(FinalGather, LeavesTheFluxAlone) {
  FakeMachine machine(1);
  begin_evenly(machine, closed_room(1, {1, 1, 1}), kAll);
  const protocol::StageLayout& layout = machine.stores[0].layout;
  const auto before = machine.store<protocol::PatchSide>(0, layout.patch_sides);
  const std::uint32_t rays = gather_side(machine, 0, 0, 0, 8);
  EXPECT_EQ(rays, 8 * protocol::hemicube_pixels(4));
  const auto first = gathered_by(machine, 0, machine.stores[0].patches[0], 0);
  gather_side(machine, 0, 0, 0, 8);
  EXPECT_EQ(gathered_by(machine, 0, machine.stores[0].patches[0], 0), first);
  const protocol::Tally tally = machine.tally(0);
  EXPECT_EQ(tally.rays, 0U);
  EXPECT_EQ(tally.gather_rays, 2 * rays);
  EXPECT_EQ(tally.escaped, Flux{});
  const auto after = machine.store<protocol::PatchSide>(0, layout.patch_sides);
  for (std::size_t s = 0; s < before.size(); ++s) {
    EXPECT_EQ(after[s].incident, before[s].incident);
    EXPECT_EQ(after[s].shot, before[s].shot);
    EXPECT_EQ(after[s].emission, before[s].emission);
  }
}

/// Of all elements after each side of an evenly lit room has shot once, and all have gathered.
struct LightOfAll {
  double apart = 0, found = 0;
};

LightOfAll gather_after_shots(float dense_shot, float mean_radiosity) {
  TestScene scene = closed_room(2, {3, 2, 2});
  scene.points = 3;
  scene.dense_shot = dense_shot;
  scene.mean_radiosity = mean_radiosity;
  FakeMachine machine(2);
  begin_evenly(machine, scene, kAll);
  std::uint32_t number = 0;
  for (std::uint16_t p = 0; p < machine.pes.size(); ++p) {
    for (const protocol::Candidate& c : machine.select(p, 100, 0))
      machine.shoot(p, {c.amount, c.patch, c.side, c.kind, number++}, 100);
  }
  LightOfAll all;
  for (const auto& [place, elements] : gather_all(machine, 4)) {
    for (const Gathered& element : elements) all.found += static_cast<double>(element.found[0]) / element.points;
  }
  for (std::uint16_t p = 0; p < machine.pes.size(); ++p) {
    for (const Element& element : machine.store<Element>(p, machine.stores[p].layout.elements))
      all.apart += static_cast<double>(element.apart[0]);
  }
  machine.stop();
  return all;
}

// What dense shots of bright sides have brought is kept apart, and not found once more; shots of sides that are no
// brighter than the mean are not.
TEST(FinalGather, LeavesDenseShotsToTheirRecords) {
  const LightOfAll none = gather_after_shots(0x1p100F, 1);
  EXPECT_EQ(none.apart, 0);
  const LightOfAll dense = gather_after_shots(0x1p-40F, 1);
  EXPECT_GT(dense.apart, none.found / 2);
  EXPECT_NEAR(dense.apart + dense.found, none.found, 0.02 * none.found);  // some 20,000 rays, all as bright within 2
  const LightOfAll dark = gather_after_shots(0x1p-40F, 0x1p100F);
  EXPECT_EQ(dark.apart, 0);
  EXPECT_EQ(dark.found, none.found);
}

/// The greatest power of two for which shots are kept apart: it is less than the limit, and half of it or more.
float most_for_apart(const std::function<double(float)>& apart_with) {
  int kept = -60;
  for (int not_kept = 100; not_kept - kept > 1;) {
    const int middle = (kept + not_kept) / 2;
    (apart_with(std::ldexp(1.0F, middle)) > 0 ? kept : not_kept) = middle;
  }
  return std::ldexp(1.0F, kept);
}

// How many records make a shot dense depends on how much brighter its side is than the mean, by the square: where it is
// at most twice as bright, a quarter and less of what a far brighter one has counts, so twice the limit is not reached.
TEST(FinalGather, WeighsDenseShotsByHowBrightTheSideIs) {
  const float limit = most_for_apart([](float dense_shot) { return gather_after_shots(dense_shot, 1).apart; });
  const float radiosity = most_for_apart([](float mean) { return gather_after_shots(0x1p-60F, mean).apart; });
  EXPECT_GT(gather_after_shots(limit / 2, 1).apart, 0);
  EXPECT_EQ(gather_after_shots(limit / 2, radiosity).apart, 0);
}

/// A block in the midst of a room, its outside the backs of its polygons, and a shell of another material around it.
TestScene block_in_shell(const protocol::Material& shell) {
  TestScene s;
  s.pes = 3;
  s.cells = {3, 2, 3};
  s.apart = kTurned;
  s.materials = {diffuse_material(kReflectance), shell};
  add_room(s, {0, 0, 0}, {1, 1, 1}, 1, 0);
  add_room(s, {0.4F, 0.4F, 0.4F}, {0.6F, 0.6F, 0.6F}, 1, 0);
  for (std::size_t i = 12; i < 24; ++i) s.polygons[i].sides = protocol::kBackPresent;
  add_room(s, {0.3F, 0.3F, 0.3F}, {0.7F, 0.7F, 0.7F}, 1, 1);
  for (std::size_t i = 24; i < 36; ++i) s.polygons[i].sides = 0;
  return s;
}

/// What the block's elements find.
std::vector<Gathered> gather_from_block(const TestScene& scene) {
  FakeMachine machine(scene.pes);
  begin_evenly(machine, scene, kAll);
  std::vector<Gathered> out;
  for (const auto& [place, elements] : gather_all(machine, 2)) {
    if (place.second == 1) out.insert(out.end(), elements.begin(), elements.end());
  }
  EXPECT_EQ(out.size(), 12U);
  EXPECT_GT(gather_rays(machine), 12U * 2 * protocol::hemicube_pixels(4));
  machine.stop();
  return out;
}

// Rays go straight on through panes, and bring what these let pass: of one that neither bends nor reflects, and takes
// half, half of what there is behind. From backs, too. Each pane counts as one of the layout's bounces.
TEST(FinalGather, GoesStraightThroughPanes) {
  TestScene scene = block_in_shell(pane_material(1, 0.5F));
  for (const Gathered& element : gather_from_block(scene)) expect_found(element, 0.5, 1e-4);
  scene.bounces = 1;
  for (const Gathered& element : gather_from_block(scene)) EXPECT_EQ(element.found, Flux{});
}

// What comes by mirrors and glass is kept apart, so rays end there and bring nothing.
TEST(FinalGather, EndsAtMirrorsAndGlass) {
  for (const protocol::Material& shell : {mirror_material(1), glass_material(1)}) {
    for (const Gathered& element : gather_from_block(block_in_shell(shell))) {
      EXPECT_EQ(element.found, Flux{});
      EXPECT_EQ(element.points, 2U);
    }
  }
}

}  // namespace
}  // namespace torolux::test
