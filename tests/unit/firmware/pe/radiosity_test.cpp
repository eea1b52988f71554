// SPDX-License-Identifier: MIT
// Proves, with whole PEs and fake NIUs: flux is neither lost nor made, every credit comes home exactly once, and the
// sums are the same bits for any number of PEs, grid, number of slots, copies, stops, and whoever makes a point's
// records.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>

#include "tests/unit/firmware/pe/radiosity_room.hpp"

namespace torolux::test {
namespace {

using protocol::Flux;

/// Everything that shots carried or glossy lobes sent on has landed somewhere. R + G + B.
void expect_balance(const RoomOutcome& out) {
  std::int64_t ended = 0;
  const auto count = [&](const Flux& f) { ended += f[0] + f[1] + f[2]; };
  for (const auto& [place, list] : out.flux) count(list[0]);
  for (const Flux* f : {&out.specular, &out.escaped, &out.cut_off, &out.back}) count(*f);
  EXPECT_EQ(ended, out.carried + out.glossy[0] + out.glossy[1] + out.glossy[2]);
}

TEST(Radiosity, FluxIsNeitherLostNorMade) {
  const RoomOutcome out = radiate(room_with_balls(4, {4, 4, 4}), 12, 64, 100);
  expect_balance(out);
  EXPECT_EQ(out.escaped, Flux{});
  EXPECT_EQ(out.back, Flux{});
  EXPECT_GT(out.specular[0], 0);
  EXPECT_GT(out.glossy[0], 0);
  EXPECT_GT(out.records, 5'000U);
}

TEST(Radiosity, WhatLeavesOrFallsOnMissingSidesIsCounted) {
  TestScene scene = room_with_balls(2, {3, 3, 3});
  scene.bounces = 2;
  for (std::size_t i = 0; i < 8; ++i) scene.polygons[i].sides = protocol::kBackPresent;  // the floor, from inside
  scene.polygons.erase(scene.polygons.begin() + 8, scene.polygons.begin() + 12);
  const RoomOutcome out = radiate(scene, 4, 64, 50);
  expect_balance(out);
  EXPECT_GT(out.escaped[0], 0);
  EXPECT_GT(out.back[0], 0);
  EXPECT_GT(out.cut_off[0], 0);
}

// Sums are integers, rays do not change at hand-over: the machine makes no difference, to the bit.
TEST(Radiosity, SameSumsWhateverTheMachine) {
  const RoomOutcome one = radiate(room_with_balls(1, {1, 1, 1}), 10, 64, 1'000'000);
  struct Machine {
    std::uint32_t pes;
    std::array<std::uint32_t, 3> cells;
    std::uint32_t slots, credits;
    bool stop_everywhere, copy_all, points_travel;
    std::uint32_t open_batches, parts;
  };
  for (const Machine& m : {Machine{1, {5, 3, 4}, 64, 77, true, true, true, 64, 1},
                           Machine{2, {2, 2, 2}, 64, 100, false, false, true, 2, protocol::kPointParts},
                           Machine{5, {4, 7, 3}, 200, 999, true, false, true, 8, 1},
                           Machine{12, {6, 6, 6}, 16, 300, false, true, true, 16, protocol::kPointParts},
                           Machine{4, {6, 6, 6}, 64, 50, true, false, false, 1, protocol::kPointParts},
                           Machine{4, {6, 6, 6}, 64, 1, false, true, true, 4, 1},
                           Machine{7, {3, 9, 5}, 64, 64, false, false, false, 4, 1}}) {
    TestScene scene = room_with_balls(m.pes, m.cells);
    scene.stop_everywhere = m.stop_everywhere;
    scene.copy_all = m.copy_all;
    scene.open_batches = m.open_batches;
    const RoomOutcome other = radiate(scene, 10, m.slots, m.credits, m.points_travel, m.parts);
    EXPECT_EQ(other.flux, one.flux) << m.pes << " PEs";
    EXPECT_EQ(other.specular, one.specular);
    EXPECT_EQ(other.glossy, one.glossy);
    EXPECT_EQ(other.records, one.records);
  }
}

// All flux falls on the floor's elements, none by chance; beside that, part of it goes on.
TEST(Radiosity, AGlossyFloorReceivesWhatADiffuseOneDoes) {
  TestScene glossy = room_with_balls(3, {3, 3, 3});
  glossy.polygons.erase(glossy.polygons.begin() + 50, glossy.polygons.end());  // without the balls
  TestScene diffuse = glossy;
  diffuse.materials[4] = diffuse_material(0.2F);
  const RoomOutcome with = radiate(glossy, 5, 64, 200);  // the lamp has five patches: emission only
  const RoomOutcome without = radiate(diffuse, 5, 64, 200);
  std::int64_t on_floor = 0;
  for (const auto& [place, list] : without.flux) {
    const std::vector<Flux>& other = with.flux.at(place);
    for (std::size_t e = 1; e + 1 < list.size(); e += 2) {
      EXPECT_EQ(other[e + 1], list[e + 1]) << "direct flux, patch " << place.first;
      EXPECT_GE(other[e][0], list[e][0]);
      if (place.first < 8 + 3 * 3) on_floor += list[e][0];  // eight polygons, three of them of four patches
    }
  }
  EXPECT_EQ(without.glossy, Flux{});
  // Of 0.7; less where half of the lobe is below the floor.
  EXPECT_GT(static_cast<double>(with.glossy[0]), 0.4 * static_cast<double>(on_floor));
  EXPECT_LT(static_cast<double>(with.glossy[0]), 0.7 * static_cast<double>(on_floor));
}

// Direct flux: only what came straight from the lamp. Behind a mirror or glass the mark is gone.
TEST(Radiosity, DirectFluxIsKeptApart) {
  TestScene scene = room_with_balls(3, {3, 3, 3});
  const RoomOutcome lamp = radiate(scene, 5, 64, 200);  // the lamp has five patches: emission only
  std::int64_t direct = 0;
  std::int64_t all = 0;
  for (const auto& [place, list] : lamp.flux) {
    for (std::size_t e = 1; e + 1 < list.size(); e += 2) {
      all += list[e][0];
      direct += list[e + 1][0];
      EXPECT_GE(list[e][0], list[e + 1][0]);
    }
  }
  EXPECT_GT(direct, all / 2);
  EXPECT_LT(direct, all);
  const RoomOutcome bare = radiate(diffuse_room(3, {3, 3, 3}), 5, 64, 200);
  for (const auto& [place, list] : bare.flux) {
    for (std::size_t e = 1; e + 1 < list.size(); e += 2) EXPECT_EQ(list[e], list[e + 1]);
  }
}

// A pane right under the lamp lets the lamp's own light through, as shadow rays will find it.
TEST(Radiosity, LightThroughAPaneIsDirect) {
  const TestScene bare = diffuse_room(3, {3, 3, 3});
  TestScene glazed = bare;
  add_pane(glazed);
  const auto on_floor = [](const RoomOutcome& outcome, std::size_t which) {
    double sum = 0;
    for (const auto& [place, list] : outcome.flux) {
      if (place.first >= 8 + 3 * 3) continue;  // eight polygons, three of them of four patches
      for (std::size_t e = which; e < list.size(); e += 2) sum += static_cast<double>(list[e][0]);
    }
    return sum;
  };
  const RoomOutcome without = radiate(bare, 5, 64, 200);
  const RoomOutcome with = radiate(glazed, 5, 64, 200);
  expect_balance(with);
  // Most of it comes at less than 45 degrees: 0.96^2 * 0.5 there, 0.45 at 45 degrees. Chance: 2,000 records.
  EXPECT_NEAR(on_floor(with, 2) / on_floor(without, 2), 0.45, 0.02);
  EXPECT_EQ(on_floor(with, 1), on_floor(with, 2)) << "no other light comes to the floor";
}

/// Of each element of a room lit by its lamp alone: flux, and what of it is kept apart by these flags.
std::vector<std::pair<Flux, Flux>> kept_apart(TestScene scene, std::uint32_t flags, std::uint32_t shots = 5) {
  scene.apart = flags;
  std::vector<std::pair<Flux, Flux>> all;
  for (const auto& [place, list] : radiate(scene, shots, 64, 200).flux) {
    for (std::size_t e = 1; e + 1 < list.size(); e += 2) all.emplace_back(list[e], list[e + 1]);
  }
  return all;
}

// Light that mirror, glass or a lobe has turned is the rest of the lamp's own: each is kept apart where it is asked
// for, and where both are, all of it is. The flux itself is the same.
TEST(Radiosity, TurnedFluxIsKeptApart) {
  const TestScene scene = room_with_balls(3, {3, 3, 3});
  const auto direct = kept_apart(scene, protocol::kDirect);
  const auto turned = kept_apart(scene, protocol::kTurned);
  const auto both = kept_apart(scene, std::uint32_t{protocol::kDirect} | protocol::kTurned);
  std::int64_t sum = 0;
  for (std::size_t e = 0; e < direct.size(); ++e) {
    const auto& [flux, straight] = direct[e];
    Flux rest = flux;
    for (std::size_t c = 0; c < 3; ++c) rest[c] -= straight[c];
    EXPECT_EQ(turned[e], std::pair(flux, rest)) << e;
    EXPECT_EQ(both[e], std::pair(flux, flux)) << e;
    sum += rest[0];
  }
  EXPECT_GT(sum, kEmitted / 100);
}

// Without mirror, glass or lobe nothing is turned, of the lamp's own light or what walls reflect.
TEST(Radiosity, LightThatGoesStraightIsNotKeptApartAsTurned) {
  const TestScene scene = diffuse_room(3, {3, 3, 3});
  std::int64_t sum = 0;
  for (const auto& [flux, apart] : kept_apart(scene, protocol::kTurned, 12)) {
    EXPECT_EQ(apart, Flux{});
    sum += flux[0];
  }
  EXPECT_GT(sum, kEmitted) << "the lamp's own light, and some of it once more";
}

// What passes a pane below the lamp goes on unbent, and is not kept apart; what the pane throws back to the ceiling is.
TEST(Radiosity, LightThroughAPaneIsNotTurned) {
  TestScene scene = diffuse_room(3, {3, 3, 3});
  scene.apart = protocol::kTurned;
  add_pane(scene);
  std::int64_t on_floor = 0;
  std::int64_t turned = 0;
  for (const auto& [place, list] : radiate(scene, 5, 64, 200).flux) {
    const bool floor = place.first < 8 + 3 * 3;  // eight polygons, three of them of four patches
    for (std::size_t e = 1; e + 1 < list.size(); e += 2) {
      if (floor) {
        EXPECT_EQ(list[e + 1], Flux{});
        on_floor += list[e][0];
      }
      turned += list[e + 1][0];
    }
  }
  EXPECT_GT(on_floor, kEmitted / 10);
  EXPECT_GT(turned, kEmitted / 100);
}

// Random little scenes on random machines: credits (checked at every grant by FakeMachine::shoot), slots and flux
// close.
TEST(Radiosity, EveryRecordEndsAsOneCreditInRandomScenes) {
  const bool holds = rc::check([] {
    const auto pick = [](std::uint32_t low, std::uint32_t high) { return *rc::gen::inRange(low, high); };
    TestScene s;
    s.pes = pick(1, 9);
    s.cells = {pick(1, 6), pick(1, 6), pick(1, 6)};
    s.hemicube_size = 2 * pick(1, 4);
    s.points = pick(1, 4);
    s.seed = pick(0, 1'000'000);
    s.bounces = pick(1, 9);
    s.materials = {diffuse_material(0.5F),
                   diffuse_material(0.5F, 1),
                   mirror_material(0.9F),
                   glass_material(1.5F, 0.9F),
                   glossy_material(0.3F, 0.69F, static_cast<float>(pick(0, 30))),
                   pane_material(1.5F, 0.9F)};
    const std::uint32_t polygons = pick(2, 30);
    for (std::uint32_t p = 0; p < polygons; ++p) {
      TestPolygon polygon{};
      for (auto& corner : polygon.corner) {
        for (float& x : corner) x = static_cast<float>(pick(0, 17)) / 16.0F;
      }
      const glm::vec3 a = pe::to_vector(polygon.corner[1]) - pe::to_vector(polygon.corner[0]);
      const glm::vec3 b = pe::to_vector(polygon.corner[2]) - pe::to_vector(polygon.corner[0]);
      if (glm::length(glm::cross(a, b)) == 0.0F) continue;
      polygon.material = p == 0 ? std::uint16_t{1} : static_cast<std::uint16_t>(pick(0, 6));
      polygon.sides = protocol::is_specular(s.materials[polygon.material].kind) ? std::uint8_t{0}
                                                                                : static_cast<std::uint8_t>(pick(1, 4));
      polygon.patch_level = static_cast<std::uint8_t>(pick(0, 2));
      polygon.element_level = static_cast<std::uint8_t>(polygon.patch_level + pick(0, 3));
      s.polygons.push_back(polygon);
    }
    s.stop_everywhere = pick(0, 2) == 1;
    s.copy_all = pick(0, 2) == 1;
    s.open_batches = 1U << pick(0, 7);
    s.credits_kept = pick(1, 100);
    expect_balance(
        radiate(s, 3, pick(16, 65), pick(1, 200), pick(0, 2) == 1, pick(0, 2) == 1 ? 1 : protocol::kPointParts));
    RC_ASSERT(!::testing::Test::HasFailure());
  });
  EXPECT_TRUE(holds);
}

}  // namespace
}  // namespace torolux::test
