// SPDX-License-Identifier: MIT
// Proves, with whole PEs and fake NIUs: flux is neither lost nor made, every credit comes home exactly once, and the
// sums are the same bits for any number of PEs, grid, number of slots, copies, stops, and whoever makes a point's
// records.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <map>

#include "tests/unit/firmware/pe/fake_machine.hpp"

namespace torolux::test {
namespace {

using protocol::Flux;
using protocol::MessageKind;
using protocol::ShotKind;
using protocol::Stage;

constexpr std::int64_t kEmitted = std::int64_t{1} << 40U;

/// A room with a lamp, a mirror ball and a glass ball, all polygons with elements, both sides of the lamp. Its floor is
/// glossy, with a lobe so wide that a share of it may be more than came.
TestScene room_with_balls(std::uint32_t pes, std::array<std::uint32_t, 3> cells) {
  TestScene s;
  s.pes = pes;
  s.cells = cells;
  s.hemicube_size = 8;
  s.points = 2;
  s.materials = {diffuse_material(0.7F), diffuse_material(0.3F, 1), mirror_material(0.9F), glass_material(1.5F, 0.95F),
                 glossy_material(0.2F, 0.7F, 1)};
  add_room(s, {0, 0, 0}, {1, 1, 1}, 2, 0);
  for (std::size_t i = 0; i < 8; ++i) s.polygons[i].material = 4;  // z low
  for (TestPolygon& p : s.polygons) p.element_level = 2;
  for (std::size_t i = 0; i < s.polygons.size(); i += 3) s.polygons[i].patch_level = 1;
  add_wall(s, {0.4F, 0.4F, 0.97F}, {0, 0.2F, 0}, {0.2F, 0, 0}, 1, 1);
  s.polygons.back().sides = 3;
  s.polygons.back().element_level = s.polygons.back().patch_level = 1;
  add_ball(s, {0.3F, 0.3F, 0.3F}, 0.2F, 6, 2, true);
  add_ball(s, {0.7F, 0.6F, 0.4F}, 0.2F, 6, 3, true);
  for (TestPolygon& p : s.polygons) {
    if (p.material == 2 || p.material == 3) p.sides = 0;
  }
  return s;
}

/// Sets all emission of the lamp, unevenly by channel.
void light_lamp(PeStores& stores) {
  for (const protocol::Patch& patch : stores.patches) {
    if (stores.polygons[stores.facets[patch.first_facet].polygon].material == 1 && patch.side[0] != protocol::kNoSide) {
      stores.sides[patch.side[0]].emission = {kEmitted, kEmitted / 3, 12345};
    }
  }
}

struct Outcome {
  /// By global patch and side: incident flux and elements' flux, direct apart.
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::vector<Flux>> flux;
  Flux specular{}, glossy{}, escaped{}, cut_off{}, back{};
  std::int64_t carried = 0;  ///< by all shots, R + G + B
  std::uint64_t records = 0;
};

void add_to(Flux& sum, const Flux& f) {
  for (std::size_t c = 0; c < 3; ++c) sum[c] += f[c];
}

void gather(FakeMachine& machine, Outcome& out) {
  for (std::uint16_t p = 0; p < machine.pes.size(); ++p) {
    const auto tally = machine.tally(p);
    add_to(out.specular, tally.absorbed_specular);
    add_to(out.glossy, tally.reflected_glossy);
    add_to(out.escaped, tally.escaped);
    add_to(out.cut_off, tally.cut_off);
    add_to(out.back, tally.back_side);
    const auto& stores = machine.stores[p];
    const auto sides = machine.store<protocol::PatchSide>(p, stores.layout.patch_sides);
    const auto elements = machine.store<protocol::Element>(p, stores.layout.elements);
    for (const protocol::Patch& patch : stores.patches) {
      for (std::uint32_t side = 0; side < 2; ++side) {
        if (patch.side[side] == protocol::kNoSide) continue;
        const protocol::PatchSide& s = sides[patch.side[side]];
        auto& list = out.flux[{patch.number, side}];
        Flux sum{};
        list.push_back(s.incident);
        for (std::uint32_t e = 0; e < patch.elements; ++e) {
          list.push_back(elements[s.first_element + e].flux);
          list.push_back(elements[s.first_element + e].direct);
          add_to(sum, elements[s.first_element + e].flux);
        }
        EXPECT_EQ(sum, s.incident) << "patch " << patch.number;
      }
    }
  }
}

/// Shoots the best side of the whole machine `shots` times, as a host would, one at a time.
Outcome radiate(const TestScene& scene, std::uint32_t shots, std::uint32_t niu_slots, std::uint32_t credits,
                bool points_travel = true, std::uint32_t parts = 1) {
  FakeMachine machine(scene.pes);
  machine.points_travel = points_travel;
  machine.shoot_in_parts = parts;
  machine.load(scene, Stage::radiosity, niu_slots, 1, light_lamp);
  for (std::uint16_t p = 0; p < scene.pes; ++p) machine.message(p, protocol::MessageKind::begin);
  machine.run();
  Outcome out;
  for (std::uint32_t shot = 0; shot < shots; ++shot) {
    std::uint16_t where = 0;
    protocol::Candidate best{};
    for (std::uint16_t p = 0; p < scene.pes; ++p) {
      for (const auto& c : machine.select(p, 1, 0)) {
        if (c.unshot > best.unshot || (c.unshot == best.unshot && c.number < best.number)) {
          best = c;
          where = p;
        }
      }
    }
    if (best.unshot == 0) break;
    out.carried += best.unshot;
    out.records += machine.shoot(where, {best.amount, best.patch, best.side, best.kind, shot}, credits);
  }
  gather(machine, out);
  machine.stop();
  return out;
}

/// Everything that shots carried or glossy lobes sent on has landed somewhere. R + G + B.
void expect_balance(const Outcome& out) {
  std::int64_t ended = 0;
  const auto count = [&](const Flux& f) { ended += f[0] + f[1] + f[2]; };
  for (const auto& [place, list] : out.flux) count(list[0]);
  for (const Flux* f : {&out.specular, &out.escaped, &out.cut_off, &out.back}) count(*f);
  EXPECT_EQ(ended, out.carried + out.glossy[0] + out.glossy[1] + out.glossy[2]);
}

TEST(Radiosity, FluxIsNeitherLostNorMade) {
  const Outcome out = radiate(room_with_balls(4, {4, 4, 4}), 12, 64, 100);
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
  const Outcome out = radiate(scene, 4, 64, 50);
  expect_balance(out);
  EXPECT_GT(out.escaped[0], 0);
  EXPECT_GT(out.back[0], 0);
  EXPECT_GT(out.cut_off[0], 0);
}

// Sums are integers, rays do not change at hand-over: the machine makes no difference, to the bit.
TEST(Radiosity, SameSumsWhateverTheMachine) {
  const Outcome one = radiate(room_with_balls(1, {1, 1, 1}), 10, 64, 1'000'000);
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
    const Outcome other = radiate(scene, 10, m.slots, m.credits, m.points_travel, m.parts);
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
  const Outcome with = radiate(glossy, 5, 64, 200);  // the lamp has five patches: emission only
  const Outcome without = radiate(diffuse, 5, 64, 200);
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
  const Outcome lamp = radiate(scene, 5, 64, 200);  // the lamp has five patches: emission only
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
  scene.polygons.erase(scene.polygons.begin() + 50, scene.polygons.end());  // without the balls
  scene.materials[4] = diffuse_material(0.2F);
  const Outcome bare = radiate(scene, 5, 64, 200);
  for (const auto& [place, list] : bare.flux) {
    for (std::size_t e = 1; e + 1 < list.size(); e += 2) EXPECT_EQ(list[e], list[e + 1]);
  }
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
    s.materials = {diffuse_material(0.5F), diffuse_material(0.5F, 1), mirror_material(0.9F), glass_material(1.5F, 0.9F),
                   glossy_material(0.3F, 0.69F, static_cast<float>(pick(0, 30)))};
    const std::uint32_t polygons = pick(2, 30);
    for (std::uint32_t p = 0; p < polygons; ++p) {
      TestPolygon polygon{};
      for (auto& corner : polygon.corner) {
        for (float& x : corner) x = static_cast<float>(pick(0, 17)) / 16.0F;
      }
      const glm::vec3 a = pe::to_vector(polygon.corner[1]) - pe::to_vector(polygon.corner[0]);
      const glm::vec3 b = pe::to_vector(polygon.corner[2]) - pe::to_vector(polygon.corner[0]);
      if (glm::length(glm::cross(a, b)) == 0.0F) continue;
      polygon.material = p == 0 ? std::uint16_t{1} : static_cast<std::uint16_t>(pick(0, 5));
      polygon.sides =
          polygon.material == 2 || polygon.material == 3 ? std::uint8_t{0} : static_cast<std::uint8_t>(pick(1, 4));
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

/// A machine with a lamp to shoot from, and what it can shoot.
struct Lamp {
  TestScene scene = room_with_balls(3, {2, 2, 2});
  FakeMachine machine{3};
  std::uint16_t owner = 0;
  protocol::Shoot shoot{};
  std::uint32_t done = 0;  ///< points

  explicit Lamp(std::uint32_t points = 2, std::uint32_t kept = 16) {
    scene.points = points;
    scene.credits_kept = kept;
    machine.load(scene, Stage::radiosity, 64, 1, light_lamp);
    for (std::uint16_t p = 0; p < 3; ++p) machine.message(p, MessageKind::begin);
    machine.run();
    for (std::uint16_t p = 0; p < 3; ++p) {
      const auto best = machine.select(p, 1, 0);
      if (best.empty()) continue;
      owner = p;
      shoot = {best[0].amount, best[0].patch, best[0].side, ShotKind::emitted, 1};
    }
    machine.message(owner, MessageKind::shoot, shoot);
  }
  void deal(std::vector<std::uint16_t> to, std::uint32_t parts = 1) {
    machine.deal(owner, to, parts);
    machine.run();
  }
  void grant(std::uint16_t pe, std::uint32_t credits) {
    machine.message(pe, MessageKind::grant, protocol::Grant{credits});
    machine.run();
  }
  /// PEs that have asked for credits since the last call.
  std::vector<std::uint16_t> asked() {
    std::vector<std::uint16_t> out;
    for (const HostMessage& m : machine.take(MessageKind::need)) out.push_back(m.source);
    return out;
  }
  /// In all, so far.
  std::uint32_t points_done() {
    for (const HostMessage& m : machine.take(MessageKind::work_done)) done += m.as<protocol::WorkDone>().points;
    return done;
  }
};

TEST(Credits, APeWithoutWorkSendsAllHome) {
  Lamp lamp(2, 1'000'000);
  for (std::uint16_t p = 0; p < 3; ++p) lamp.grant(p, 17);
  EXPECT_EQ(lamp.machine.take_credits(), 3 * 17U);
  lamp.deal({1});
  lamp.grant(1, 1'000'000);  // far more than a point needs
  EXPECT_EQ(lamp.points_done(), 1U);
  EXPECT_EQ(lamp.machine.take_credits(), 1'000'000U);
  EXPECT_FALSE(pe::has_work(lamp.machine.pes[1]->state()));
}

TEST(Credits, APeWithWorkAndNoneAsksOnce) {
  Lamp lamp;
  EXPECT_TRUE(lamp.asked().empty()) << "nobody has work";
  lamp.deal({2});
  EXPECT_EQ(lamp.asked(), std::vector<std::uint16_t>{2});
  lamp.deal({2});
  EXPECT_TRUE(lamp.asked().empty()) << "it has asked, and none came";
  lamp.grant(2, 1);
  // With one credit each record's end allows for the next where it ends: here or at another PE, which sends it home.
  EXPECT_LE(lamp.asked().size(), 1U);
  for (int turn = 0; lamp.points_done() < 2; ++turn) {
    ASSERT_LT(turn, 1'000);
    lamp.grant(2, 5);
    EXPECT_LE(lamp.asked().size(), 1U);
  }
}

// Until it has none; then it asks again, with the rest of its work still there.
TEST(Credits, OneCreditIsEnoughAndIsNeverLost) {
  Lamp lamp;
  lamp.deal({0, 1, 2, 0});
  std::vector<std::uint16_t> in_need = lamp.asked();
  EXPECT_EQ(in_need.size(), 3U);
  for (int turn = 0; lamp.points_done() < 4; ++turn) {
    ASSERT_LT(turn, 10'000);
    ASSERT_FALSE(in_need.empty());
    lamp.grant(in_need.front(), 1);
    in_need.erase(in_need.begin());
    ASSERT_EQ(lamp.machine.take_credits(), 1U) << "it comes home whenever everybody sleeps";
    for (const std::uint16_t pe : lamp.asked()) in_need.push_back(pe);
  }
}

// While a PE has work it keeps what it is told to, and sends home what is far beyond, before it works on.
TEST(Credits, SurplusGoesHome) {
  for (const std::uint32_t surplus : {63U, 64U, 900U}) {
    Lamp lamp(2, 1'000);
    lamp.deal({1});
    lamp.machine.to_host.clear();
    lamp.grant(1, 1'000 + surplus);
    const auto& heard = lamp.machine.to_host;
    const auto kind_is = [](MessageKind kind) { return [kind](const HostMessage& m) { return m.kind == kind; }; };
    const auto done = std::find_if(heard.begin(), heard.end(), kind_is(MessageKind::work_done));
    const auto home = std::find_if(heard.begin(), heard.end(), kind_is(MessageKind::credits));
    ASSERT_NE(done, heard.end());
    ASSERT_NE(home, heard.end());
    EXPECT_EQ(home < done, surplus >= 64) << surplus << " are no longer worth keeping";
    if (home < done) {
      EXPECT_EQ(home->as<protocol::Credits>().count, surplus);
    }
    EXPECT_EQ(lamp.machine.take_credits(), 1'000 + surplus);
  }
}

// Whoever makes a point's records, or a part of them, they are the same ones: the sums of all elements are those that
// the owner alone makes, and each PE tells the host of its own.
TEST(Points, SameRecordsWhoeverMakesThem) {
  // to: who gets each piece; of a point, or of a part of one.
  const auto shot_by = [](const std::vector<std::uint16_t>& to, std::uint32_t parts) {
    Lamp lamp;
    std::map<std::uint16_t, protocol::WorkDone> done;
    std::uint32_t pieces = 0;
    for (std::size_t first = 0; first < to.size(); first += 4) {  // so that nobody has more than it has places for
      lamp.deal({to.begin() + static_cast<std::ptrdiff_t>(first), to.begin() + static_cast<std::ptrdiff_t>(first + 4)},
                parts);
      for (int turn = 0; pieces < first + 4 && turn < 1'000; ++turn) {
        for (const std::uint16_t pe : lamp.asked()) lamp.grant(pe, 40);
        for (const HostMessage& m : lamp.machine.take(MessageKind::work_done)) {
          const auto part = m.as<protocol::WorkDone>();
          done[m.source].points += part.points;
          done[m.source].records += part.records;
          pieces += part.points;
        }
      }
    }
    EXPECT_EQ(pieces, to.size());
    Outcome out;
    gather(lamp.machine, out);
    for (const auto& [pe, part] : done) {
      EXPECT_EQ(part.points, std::count(to.begin(), to.end(), pe));
      EXPECT_EQ(part.records, lamp.machine.tally(pe).rays);
      out.records += part.records;
    }
    return out;
  };
  const Outcome alone = shot_by({0, 0, 0, 0}, 1);
  EXPECT_GT(alone.records, 500U);
  const auto expect_same = [&alone](const Outcome& other) {
    EXPECT_EQ(other.flux, alone.flux);
    EXPECT_EQ(other.specular, alone.specular);
    EXPECT_EQ(other.glossy, alone.glossy);
    EXPECT_EQ(other.records, alone.records);
  };
  for (const std::vector<std::uint16_t>& to :
       {std::vector<std::uint16_t>{1, 1, 1, 1}, {2, 2, 2, 2}, {0, 1, 2, 0}, {2, 1, 0, 1}}) {
    expect_same(shot_by(to, 1));
  }
  std::vector<std::uint16_t> to(4 * protocol::kPointParts, 1);
  expect_same(shot_by(to, protocol::kPointParts));
  for (std::size_t i = 0; i < to.size(); ++i) to[i] = static_cast<std::uint16_t>(i * i % 7 % 3);
  expect_same(shot_by(to, protocol::kPointParts));
}

// A shot without flux has points all the same, and they are done without a record.
TEST(Points, WithoutFluxMakeNoRecords) {
  Lamp lamp;
  lamp.deal({0, 1, 2, 0});  // the rest of the shot before
  for (int turn = 0; lamp.points_done() < 4; ++turn) {
    ASSERT_LT(turn, 1'000);
    for (const std::uint16_t pe : lamp.asked()) lamp.grant(pe, 1'000);
  }
  lamp.machine.take_credits();
  lamp.shoot.amount = {0, 0, 0};
  EXPECT_EQ(lamp.machine.shoot(lamp.owner, lamp.shoot), 0U);
}

}  // namespace
}  // namespace torolux::test
