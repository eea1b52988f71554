// SPDX-License-Identifier: MIT
// A round of shots as the host conducts it: to whom points are dealt, how credits go out and come home, when it ends.
#include <random>

#include "firmware/protocol/flux.hpp"
#include "firmware/protocol/shot_grid.hpp"
#include "tests/unit/host_tools/stages/radiosity_messages.hpp"

namespace torolux::test {
namespace {

TEST(RadiosityPhase, PointsAreDealtToAllPesAndMoreToWhoHasDoneSome) {
  FakePort port(3);
  RadiosityPhase phase = one_shot(port, settings(3), 1);
  auto sent = port.take();
  ASSERT_TRUE(sent.at(0).is(MessageKind::grant)) << "credits wait for the points";
  ASSERT_TRUE(sent.at(1).is(MessageKind::shoot)) << "the owner hears what it is before whom it goes to";
  EXPECT_EQ(sent.at(1).pe, 1);
  EXPECT_EQ(deals_in(sent, PeNumber{1}), (std::vector<PeNumber>{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(deals_in(sent).size(), 6U) << "nobody else deals";
  tell(phase, port, 2, MessageKind::work_done, protocol::WorkDone{2, 100});
  EXPECT_EQ(deals_in(port.take(), PeNumber{1}), (std::vector<PeNumber>{2, 2}));
  std::uint32_t dealt = 8 * protocol::kPointParts;
  std::vector<std::uint32_t> of_pe{2 * protocol::kPointParts, 2 * protocol::kPointParts, 4 * protocol::kPointParts};
  std::vector<std::uint32_t> has{2, 2, 2};
  std::uint32_t in_parts = 0;
  for (PeNumber pe = 0; has != std::vector<std::uint32_t>{0, 0, 0}; pe = static_cast<PeNumber>((pe + 1) % 3)) {
    if (has[pe] == 0) continue;
    --has[pe];
    tell(phase, port, pe, MessageKind::work_done, protocol::WorkDone{1, 100});
    for (const Piece& piece : pieces_in(port.take(), PeNumber{1})) {
      EXPECT_EQ(piece.to, pe);
      ++has[piece.to];
      of_pe[piece.to] += piece.of_point;
      dealt += piece.of_point;
      in_parts += piece.of_point == 1 ? 1 : 0;
      EXPECT_LE(has[piece.to], protocol::kPointPlaces);
    }
  }
  EXPECT_EQ(dealt, 64U * protocol::kPointParts);
  EXPECT_EQ(in_parts, 5U * protocol::kPointParts) << "when less than two for each of three PEs are left";
  EXPECT_GE(*std::min_element(of_pe.begin(), of_pe.end()), 19U * protocol::kPointParts);
}

// At the end nobody has two pieces while another has none.
TEST(RadiosityPhase, TheLastPiecesGoToWhoHasNothing) {
  FakePort port(9);
  RadiosityPhase phase = one_shot(port, settings(9), 3, 1);
  EXPECT_EQ(deals_in(port.take()), (std::vector<PeNumber>{0, 1, 2, 3, 4, 5, 6, 7})) << "the eight parts of one point";
}

TEST(RadiosityPhase, PointsStayAtTheirOwnersWhereTheyDoNotTravel) {
  FakePort port(3);
  RadiositySettings some = settings(3);
  some.points_travel = false;
  RadiosityPhase phase = one_shot(port, some, 1);
  const auto sent = port.take();
  EXPECT_EQ(deals_in(sent), (std::vector<PeNumber>{1, 1}));
  EXPECT_EQ(grants_in(sent, 3).size(), 1U) << "nobody else has work";
  tell(phase, port, 1, MessageKind::work_done, protocol::WorkDone{1, 100});
  EXPECT_EQ(deals_in(port.take()), (std::vector<PeNumber>{1}));
  const auto whole = [](const Piece& piece) { return piece.of_point == protocol::kPointParts; };
  for (std::uint32_t point = 3; point < 64; ++point) {
    tell(phase, port, 1, MessageKind::work_done, protocol::WorkDone{1, 100});
    const auto pieces = pieces_in(port.take());
    EXPECT_TRUE(std::all_of(pieces.begin(), pieces.end(), whole)) << "there is nobody to share with";
  }
}

TEST(RadiosityPhase, OwnersMakePointsInTurnAndOneShotAfterTheOther) {
  FakePort port(2);
  RadiositySettings some = settings(2);
  some.emission_points = 2;
  RadiosityPhase phase(some);
  phase.start(port);
  port.take();
  const auto lamp = [](std::uint32_t number) { return candidate(400 - number, number, 0, ShotKind::emitted); };
  offer(phase, port, 0, {lamp(1), lamp(2)}, 1000);
  offer(phase, port, 1, {lamp(3)}, 1000);
  auto sent = port.take();
  EXPECT_EQ(shots_in(sent).size(), 2U) << "the first of each";
  EXPECT_EQ(deals_in(sent, PeNumber{0}), (std::vector<PeNumber>{0, 0}));
  EXPECT_EQ(deals_in(sent, PeNumber{1}), (std::vector<PeNumber>{1, 1}));
  tell(phase, port, 0, MessageKind::work_done, protocol::WorkDone{2, 100});
  sent = port.take();
  EXPECT_EQ(deals_in(sent, PeNumber{0}), (std::vector<PeNumber>{0}));
  EXPECT_EQ(deals_in(sent, PeNumber{1}), (std::vector<PeNumber>{0}));
  EXPECT_TRUE(shots_in(sent).empty());
  // One point is left of each of the first two shots; then the second of PE 0 begins.
  tell(phase, port, 1, MessageKind::work_done, protocol::WorkDone{1, 100});
  tell(phase, port, 1, MessageKind::work_done, protocol::WorkDone{1, 100});
  EXPECT_TRUE(shots_in(port.take()).empty());
  tell(phase, port, 0, MessageKind::work_done, protocol::WorkDone{1, 100});
  sent = port.take();
  ASSERT_EQ(sent.size(), 2U);
  ASSERT_TRUE(sent[0].is(MessageKind::shoot));
  EXPECT_EQ(sent[0].as<Shoot>().number, 1U);
  EXPECT_TRUE(sent[1].is(MessageKind::deal));
}

TEST(RadiosityPhase, ADealIsNoLongerThanItsMessage) {
  FakePort port(50);
  RadiositySettings some = settings(50);
  some.credits = 5000;
  RadiosityPhase phase = one_shot(port, some, 7, 16);
  std::vector<std::uint32_t> counts;
  for (const Sent& one : port.take()) {
    if (one.is(MessageKind::deal)) counts.push_back(one.as<std::uint32_t>());
  }
  EXPECT_EQ(counts, (std::vector<std::uint32_t>{64, 36})) << "two points for each of 50 PEs";
}

/// PEs that work at random: what they have in hand becomes records, which die anywhere.
class RandomPes {
 public:
  RandomPes(RadiosityPhase& phase, FakePort& port, const RadiositySettings& settings, std::uint32_t seed)
      : phase_(phase), port_(port), settings_(settings), random_(seed) {}

  /// Until the host selects again. Checks each step.
  void work_until_the_round_ends() {
    recalled_ = false;
    for (int step = 0; listen(); ++step) {
      ASSERT_LT(step, 100'000);
      ASSERT_EQ(out_ + phase_.credits_home(), settings_.credits);
      act(static_cast<PeNumber>(random_() % 3));
    }
    EXPECT_EQ(out_, 0U);
    for (const auto& [pe, points] : points_) EXPECT_EQ(points, 0U);
    for (const auto& [pe, left] : left_) EXPECT_EQ(left, 0U) << "points never dealt";
  }
  std::uint64_t shots() const { return shots_; }
  std::uint64_t points() const { return dealt_; }  ///< in parts

 private:
  /// What the host has sent; false: a new selection.
  bool listen() {
    const std::vector<Sent> all = port_.take();
    for (const Sent& sent : all) {
      if (sent.is(MessageKind::select)) return false;
      if (sent.is(MessageKind::shoot)) {
        EXPECT_EQ(left_[sent.pe], 0U) << "a shot while another has points left";
        const auto shoot = sent.as<Shoot>();
        left_[sent.pe] =
            protocol::kPointParts * protocol::points_of_shot(shoot.kind, shoot.amount, settings_.points_per_quantum,
                                                             settings_.shot_points, settings_.emission_points);
        ++shots_;
      } else if (sent.is(MessageKind::deal)) {
        for (const Piece& piece : pieces_in({sent})) {
          EXPECT_GE(left_[sent.pe], piece.of_point) << "more points than there are";
          EXPECT_EQ(left_[sent.pe] % piece.of_point, 0U) << "a whole point after some parts of one";
          left_[sent.pe] -= piece.of_point;
          EXPECT_LE(++points_[piece.to], protocol::kPointPlaces);
          dealt_ += piece.of_point;
        }
      } else if (sent.is(MessageKind::recall)) {
        EXPECT_EQ(sent.pe, protocol::kHost) << "to all";
        EXPECT_FALSE(recalled_) << "once is enough";
        recalled_ = true;
      } else {
        EXPECT_TRUE(sent.is(MessageKind::grant));
        for (const auto& [pe, credits] : grants_in({sent}, 3)) {
          held_[pe] += credits;
          out_ += credits;
          asked_[pe] = false;
        }
      }
    }
    return true;
  }

  void act(PeNumber pe) {
    if (points_[pe] > 0 && held_[pe] > 0) {
      const std::uint64_t moved = random_() % (held_[pe] + 1);  // their records die at another
      held_[pe] -= moved;
      held_[static_cast<PeNumber>(random_() % 3)] += moved;
      if (random_() % 3 != 0) return;
      --points_[pe];
      tell(phase_, port_, pe, MessageKind::work_done, protocol::WorkDone{1, 5});
    } else if (points_[pe] > 0 && !asked_[pe]) {
      asked_[pe] = true;
      tell(phase_, port_, pe, MessageKind::need);
    } else if (points_[pe] == 0 && held_[pe] > 0 && recalled_) {
      const auto all = static_cast<std::uint32_t>(held_[pe]);
      out_ -= all;
      held_[pe] = 0;
      tell(phase_, port_, pe, MessageKind::credits, protocol::Credits{all});
    }
  }

  RadiosityPhase& phase_;
  FakePort& port_;
  RadiositySettings settings_;
  std::minstd_rand random_;
  std::map<PeNumber, std::uint32_t> left_;    ///< of the owner's shot in progress, parts of points still to be dealt
  std::map<PeNumber, std::uint32_t> points_;  ///< dealt to it, or parts of points, and not done
  std::map<PeNumber, std::uint64_t> held_;    ///< credits granted and not home
  std::map<PeNumber, bool> asked_;
  bool recalled_ = false;  ///< without work they go home
  std::uint64_t out_ = 0;  ///< credits, their sum
  std::uint64_t shots_ = 0, dealt_ = 0;
};

TEST(RadiosityPhase, CreditsAreNeverMoreThanThereAreAndAllComeHome) {
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    FakePort port(3);
    RadiositySettings some = settings(3);
    some.credits = 1 + seed * 37 % 300;
    some.shot_points = 1 + seed % 5;
    some.points_per_quantum = 1'000;
    some.points_travel = seed % 2 == 0;
    RadiosityPhase phase(some);
    phase.start(port);
    port.take();
    for (const std::uint32_t pe : {1U, 0U, 2U}) {
      offer(phase, port, static_cast<PeNumber>(pe), {candidate(100 + pe, pe), candidate(90, pe + 10)}, 1000);
    }
    RandomPes pes(phase, port, some, seed);
    pes.work_until_the_round_ends();
    EXPECT_EQ(pes.shots(), 4U) << "seed " << seed;
    EXPECT_EQ(pes.points(), protocol::kPointParts * 4U * some.shot_points * some.shot_points);
    EXPECT_EQ(phase.shots(), 4U);
    EXPECT_EQ(phase.credits_home(), some.credits);
  }
}

// Half of what there is goes to all, in one message; the rest is for those who have more work than others.
TEST(RadiosityPhase, WhoNeedsCreditsGetsThemInTheOrderOfAsking) {
  FakePort port(4);
  RadiosityPhase phase = one_shot(port, settings(4), 2);
  const auto begin = port.take();
  EXPECT_EQ(std::ranges::count_if(begin, [](const Sent& one) { return one.is(MessageKind::grant); }), 1);
  EXPECT_EQ(grants_in(begin, 4), (std::map<PeNumber, std::uint32_t>{{0, 12}, {1, 12}, {2, 12}, {3, 12}}));
  EXPECT_EQ(phase.credits_home(), 52U);
  for (const std::uint32_t left : {40U, 28U, 16U, 4U}) {
    tell(phase, port, 3, MessageKind::need);
    EXPECT_EQ(grants_in(port.take(), 4), (std::map<PeNumber, std::uint32_t>{{3, 12}})) << "half a share";
    EXPECT_EQ(phase.credits_home(), left);
  }
  tell(phase, port, 1, MessageKind::need);
  EXPECT_EQ(grants_in(port.take(), 4), (std::map<PeNumber, std::uint32_t>{{1, 4}})) << "what there is";
  tell(phase, port, 3, MessageKind::need);
  const auto recall = port.take();
  ASSERT_EQ(recall.size(), 1U) << "there are none";
  EXPECT_TRUE(recall[0].is(MessageKind::recall) && recall[0].pe == protocol::kHost);
  tell(phase, port, 0, MessageKind::need);
  EXPECT_TRUE(port.take().empty()) << "once is enough";
  tell(phase, port, 1, MessageKind::credits, protocol::Credits{5});
  EXPECT_EQ(grants_in(port.take(), 4), (std::map<PeNumber, std::uint32_t>{{3, 5}}));
  tell(phase, port, 1, MessageKind::credits, protocol::Credits{11});
  EXPECT_EQ(grants_in(port.take(), 4), (std::map<PeNumber, std::uint32_t>{{0, 11}}));
}

// One credit for each PE cannot be halved; neither can fewer than there are PEs.
TEST(RadiosityPhase, FewCreditsGoToWhoHasWork) {
  FakePort port(4);
  RadiositySettings some = settings(4);
  some.credits = 7;
  RadiosityPhase phase = one_shot(port, some, 2);
  EXPECT_EQ(grants_in(port.take(), 4), (std::map<PeNumber, std::uint32_t>{{0, 1}, {1, 1}, {2, 1}, {3, 1}}));
  EXPECT_EQ(phase.credits_home(), 3U);
}

// Both must be there: every point done, every credit home.
TEST(RadiosityPhase, ARoundEndsWithTheLastPointAndTheLastCredit) {
  for (const bool credits_last : {false, true}) {
    FakePort port(1);
    RadiosityPhase phase(settings(1));
    phase.start(port);
    port.take();
    offer(phase, port, 0, {candidate(400, 1)}, 1000);
    EXPECT_EQ(grants_in(port.take(), 1), (std::map<PeNumber, std::uint32_t>{{0, 50}}));
    for (int part = 0; part < 7; ++part) tell(phase, port, 0, MessageKind::work_done, protocol::WorkDone{1, 10});
    EXPECT_EQ(deals_in(port.take()).size(), 6U) << "eight in all";
    const auto done = [&] { tell(phase, port, 0, MessageKind::work_done, protocol::WorkDone{1, 12}); };
    const auto home = [&] { tell(phase, port, 0, MessageKind::credits, protocol::Credits{50}); };
    credits_last ? done() : home();
    const auto before = port.take();
    EXPECT_EQ(before.size(), credits_last ? 1U : 0U);
    EXPECT_TRUE(!credits_last || before[0].is(MessageKind::recall)) << "no work is left, so the credits are not needed";
    credits_last ? home() : done();
    const auto sent = port.take();
    ASSERT_EQ(sent.size(), 1U);
    EXPECT_TRUE(sent[0].is(MessageKind::select)) << "the next round";
    EXPECT_EQ(phase.rounds().front().records, 82U);
  }
}

}  // namespace
}  // namespace torolux::test
