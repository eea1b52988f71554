// SPDX-License-Identifier: MIT
// Proves, with whole PEs and fake NIUs: credits are asked for once and come home, and a point's records are the same
// ones whoever makes them.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "tests/unit/firmware/pe/radiosity_room.hpp"

namespace torolux::test {
namespace {

using protocol::Flux;
using protocol::MessageKind;
using protocol::ShotKind;
using protocol::Stage;

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
    RoomOutcome out;
    gather(lamp.machine, out);
    for (const auto& [pe, part] : done) {
      EXPECT_EQ(part.points, std::count(to.begin(), to.end(), pe));
      EXPECT_EQ(part.records, lamp.machine.tally(pe).rays);
      out.records += part.records;
    }
    return out;
  };
  const RoomOutcome alone = shot_by({0, 0, 0, 0}, 1);
  EXPECT_GT(alone.records, 500U);
  const auto expect_same = [&alone](const RoomOutcome& other) {
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
