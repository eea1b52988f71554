// SPDX-License-Identifier: MIT
// The host's conduct of the radiosity stage: whom it lets shoot and how much, how credits go out and come home, and
// when it ends. PEs are the test itself, so each message can come at any moment.
#include "host_tools/stages/radiosity_phase.hpp"

#include <gtest/gtest.h>

#include <map>
#include <optional>
#include <random>

#include "firmware/protocol/flux.hpp"
#include "firmware/protocol/shot_grid.hpp"
#include "tests/unit/host/fake_port.hpp"

namespace torolux::test {
namespace {

using protocol::Candidate;
using protocol::MessageKind;
using protocol::Shoot;
using protocol::ShotKind;

Candidate candidate(std::int64_t unshot, std::uint32_t number, std::uint32_t side = 0,
                    ShotKind kind = ShotKind::reflected) {
  return {{2 * unshot, unshot, 4}, unshot, number, number / 3, side, kind};
}

void offer(RadiosityPhase& phase, FakePort& port, PeNumber pe, const std::vector<Candidate>& candidates,
           std::int64_t unshot, bool last = true) {
  protocol::Candidates message{};
  message.count = static_cast<std::uint32_t>(candidates.size());
  message.last = last ? 1 : 0;
  message.unshot = {unshot, 0, 0};
  std::copy(candidates.begin(), candidates.end(), message.candidate.begin());
  const std::size_t bytes = offsetof(protocol::Candidates, candidate) + candidates.size() * sizeof(Candidate);
  phase.on_message(port, pe, MessageKind::candidates, std::as_bytes(std::span(&message, 1)).first(bytes));
}

RadiositySettings settings(unsigned pes) {
  RadiositySettings result;
  result.pes = pes;
  result.credits = 100;
  result.shooters = 4;
  result.least_unshot = 7;
  result.enough_unshot = 50;
  result.emitted = 10'000;
  result.reflectance.assign(30, {protocol::kOne / 2, protocol::kOne / 4, protocol::kOne});
  return result;
}

std::vector<std::pair<PeNumber, Shoot>> shots_in(const std::vector<Sent>& sent) {
  std::vector<std::pair<PeNumber, Shoot>> shots;
  for (const Sent& one : sent) {
    if (one.is(MessageKind::shoot)) shots.emplace_back(one.pe, one.as<Shoot>());
  }
  return shots;
}

/// Credits granted to PEs 0..pes-1, by PE: to one, or by broadcast to each.
std::map<PeNumber, std::uint32_t> grants_in(const std::vector<Sent>& sent, unsigned pes) {
  std::map<PeNumber, std::uint32_t> grants;
  for (const Sent& one : sent) {
    if (!one.is(MessageKind::grant)) continue;
    for (unsigned pe = 0; pe < pes; ++pe) {
      if (one.pe == pe || one.pe == protocol::kHost) {
        grants[static_cast<PeNumber>(pe)] += one.as<protocol::Grant>().credits;
      }
    }
  }
  return grants;
}

/// A point that was dealt, or a part of one.
struct Piece {
  PeNumber to;
  std::uint32_t of_point;  ///< in parts of kPointParts
};

/// In the order of dealing; of one owner or all.
std::vector<Piece> pieces_in(const std::vector<Sent>& sent, std::optional<PeNumber> owner = {}) {
  std::vector<Piece> pieces;
  for (const Sent& one : sent) {
    if (!one.is(MessageKind::deal) || (owner && one.pe != *owner)) continue;
    protocol::Deal deal{};
    std::memcpy(&deal, one.bytes.data(), std::min(one.bytes.size(), sizeof deal));
    EXPECT_EQ(one.bytes.size(), offsetof(protocol::Deal, pe) + deal.count * sizeof(PeNumber)) << "no more is sent";
    EXPECT_TRUE(deal.parts == 1 || deal.parts == protocol::kPointParts);
    for (std::uint32_t i = 0; i < deal.count; ++i) pieces.push_back({deal.pe[i], protocol::kPointParts / deal.parts});
  }
  return pieces;
}

/// Who was dealt something.
std::vector<PeNumber> deals_in(const std::vector<Sent>& sent, std::optional<PeNumber> owner = {}) {
  std::vector<PeNumber> to;
  for (const Piece& piece : pieces_in(sent, owner)) to.push_back(piece.to);
  return to;
}

/// Tells that all points dealt are done and all credits granted are home, until the host asks for candidates or is
/// done. Adds up the messages.
std::vector<Sent> finish_round(RadiosityPhase& phase, FakePort& port) {
  std::vector<Sent> all;
  for (std::vector<Sent> sent = port.take(); !sent.empty(); sent = port.take()) {
    all.insert(all.end(), sent.begin(), sent.end());
    if (sent.back().is(MessageKind::select)) break;
    for (const PeNumber to : deals_in(sent)) tell(phase, port, to, MessageKind::work_done, protocol::WorkDone{1, 5});
    for (const auto& [pe, credits] : grants_in(sent, port.pes())) tell(phase, port, pe, MessageKind::credits, credits);
  }
  return all;
}

/// The shots of the first round by their number.
std::map<std::uint32_t, std::pair<PeNumber, Shoot>> first_round(const std::vector<std::vector<Candidate>>& offers,
                                                                const std::vector<PeNumber>& order) {
  FakePort port(3);
  RadiosityPhase phase(settings(3));
  phase.start(port);
  port.take();
  for (const PeNumber pe : order) offer(phase, port, pe, offers[pe], 1000);
  std::map<std::uint32_t, std::pair<PeNumber, Shoot>> shots;
  for (const auto& [pe, shoot] : shots_in(finish_round(phase, port))) shots[shoot.number] = {pe, shoot};
  return shots;
}

TEST(RadiosityPhase, AsksAllPesForTheirBest) {
  FakePort port(3);
  RadiosityPhase phase(settings(3));
  phase.start(port);
  const auto sent = port.take();
  ASSERT_EQ(sent.size(), 1U) << "once, to all";
  EXPECT_EQ(sent[0].pe, protocol::kHost);
  ASSERT_TRUE(sent[0].is(MessageKind::select));
  EXPECT_EQ(sent[0].as<protocol::Select>().count, 4U);
  EXPECT_EQ(sent[0].as<protocol::Select>().threshold, 7);
}

TEST(RadiosityPhase, SaysWhatItComputes) {
  FakePort port(3);
  RadiosityPhase phase(settings(3));
  phase.start(port);
  offer(phase, port, 0, {candidate(500, 6), candidate(400, 1)}, 1000);
  offer(phase, port, 1, {candidate(300, 9), candidate(200, 8), candidate(100, 0)}, 1000);
  EXPECT_EQ(port.done(HostWork::entry), 5U) << "candidates taken in";
  EXPECT_EQ(port.done(HostWork::compare), 0U);
  port.take();  // what was asked is on its way
  offer(phase, port, 2, {}, 1000);
  EXPECT_EQ(port.done(HostWork::compare), 5U * 3) << "five are sorted";
  // Each of the three PEs gets two parts of the four shots' points; all get credits at once.
  EXPECT_EQ(port.done(HostWork::entry), 5U + 6 + 1);
}

TEST(RadiosityPhase, TheBestOfAllPesShootAndTheirNumbersFollowTheOrderOfChoice) {
  // Of seven the best four: 900; of the three 500s the lower patch, then front before back, emitted before reflected.
  const std::vector<std::vector<Candidate>> offers = {
      {candidate(500, 6, 1, ShotKind::emitted), candidate(400, 1)},
      {candidate(500, 6, 0), candidate(500, 6, 0, ShotKind::emitted), candidate(100, 0)},
      {candidate(900, 20), candidate(500, 5, 1)},
  };
  const auto shots = first_round(offers, {0, 1, 2});
  ASSERT_EQ(shots.size(), 4U);
  EXPECT_EQ(shots.at(0).first, 2);
  EXPECT_EQ(shots.at(0).second.patch, 20U / 3);
  EXPECT_EQ(shots.at(1).first, 2);
  EXPECT_EQ(shots.at(1).second.side, 1U);
  EXPECT_EQ(shots.at(2).first, 1);
  EXPECT_EQ(shots.at(2).second.kind, ShotKind::emitted);
  EXPECT_EQ(shots.at(3).first, 1);
  EXPECT_EQ(shots.at(3).second.kind, ShotKind::reflected);
  EXPECT_EQ(shots.at(3).second.amount, (protocol::Flux{1000, 500, 4})) << "exactly what was offered";

  for (const std::vector<PeNumber>& order : {std::vector<PeNumber>{2, 1, 0}, {1, 2, 0}, {0, 2, 1}}) {
    const auto others = first_round(offers, order);
    ASSERT_EQ(others.size(), 4U);
    for (const auto& [number, shot] : shots) {
      EXPECT_EQ(others.at(number).first, shot.first);
      EXPECT_EQ(std::memcmp(&others.at(number).second, &shot.second, sizeof(Shoot)), 0) << "shot " << number;
    }
  }
}

/// Sides with no more than this are not to be named.
std::vector<std::int64_t> thresholds_in(const std::vector<Sent>& sent) {
  std::vector<std::int64_t> thresholds;
  for (const Sent& one : sent) {
    if (one.is(MessageKind::select)) thresholds.push_back(one.as<protocol::Select>().threshold);
  }
  return thresholds;
}

// Most sides have less than any that is chosen: they are named only where others are too few, so the choice is the
// same.
TEST(RadiosityPhase, PesNameWhatMayBeChosenAndTheRestIfThatIsTooLittle) {
  FakePort port(2);
  RadiosityPhase phase(settings(2));
  phase.start(port);
  EXPECT_EQ(thresholds_in(port.take()), std::vector<std::int64_t>{7});
  offer(phase, port, 0, {candidate(900, 1), candidate(100, 2), candidate(20, 3)}, 1000);
  offer(phase, port, 1, {candidate(800, 4), candidate(700, 5)}, 2000);
  EXPECT_EQ(thresholds_in(finish_round(phase, port)), std::vector<std::int64_t>{75}) << "3/4 of the least one chosen";
  offer(phase, port, 0, {candidate(80, 1), candidate(90, 2)}, 900);
  offer(phase, port, 1, {candidate(95, 4), candidate(76, 5)}, 900);
  EXPECT_EQ(thresholds_in(finish_round(phase, port)), std::vector<std::int64_t>{57}) << "four were enough";
  EXPECT_EQ(phase.shots(), 8U);
  offer(phase, port, 0, {candidate(80, 1)}, 800);
  offer(phase, port, 1, {candidate(95, 4), candidate(76, 5)}, 800);
  EXPECT_EQ(thresholds_in(port.take()), std::vector<std::int64_t>{7}) << "three are too few";
  offer(phase, port, 0, {candidate(80, 1), candidate(40, 2)}, 800);
  offer(phase, port, 1, {candidate(95, 4), candidate(76, 5), candidate(30, 6)}, 800);
  EXPECT_EQ(thresholds_in(finish_round(phase, port)), std::vector<std::int64_t>{30});
  EXPECT_EQ(phase.rounds().size(), 4U) << "asked twice, it is one round";
  offer(phase, port, 0, {}, 20);
  offer(phase, port, 1, {}, 20);
  EXPECT_TRUE(phase.done()) << "little is unshot, whatever was not named";
}

TEST(RadiosityPhase, SumsOfFluxShotAreThoseOfTheAmounts) {
  FakePort port(1);
  RadiosityPhase phase(settings(1));
  phase.start(port);
  offer(phase, port, 0, {candidate(400, 1), candidate(300, 2, 0, ShotKind::emitted)}, 1000);
  EXPECT_EQ(phase.emitted_shot(), (protocol::Flux{600, 300, 4}));
  EXPECT_EQ(phase.reflected_shot(), (protocol::Flux{400, 100, 4})) << "amount times reflectance 1/2, 1/4, 1";
}

TEST(RadiosityPhase, EndsWhenLittleIsUnshot) {
  for (const std::int64_t unshot : {25, 26}) {
    FakePort port(2);
    RadiosityPhase phase(settings(2));
    phase.start(port);
    port.take();
    offer(phase, port, 0, {candidate(20, 1)}, unshot);
    EXPECT_FALSE(phase.done());
    offer(phase, port, 1, {}, 25);
    EXPECT_EQ(phase.done(), unshot == 25) << "25 + 25 is enough, 26 + 25 is not";
    EXPECT_EQ(shots_in(port.take()).empty(), unshot == 25);
    EXPECT_EQ(phase.unshot(), unshot + 25);
  }
}

TEST(RadiosityPhase, EndsWhereNobodyHasAnythingToShoot) {
  FakePort port(1);
  RadiosityPhase phase(settings(1));
  phase.start(port);
  offer(phase, port, 0, {}, 1000);
  EXPECT_TRUE(phase.done());
}

TEST(RadiosityPhase, CandidatesMayComeInSeveralMessages) {
  FakePort port(1);
  RadiositySettings some = settings(1);
  some.shooters = 30;
  RadiosityPhase phase(some);
  phase.start(port);
  port.take();
  std::vector<Candidate> many;
  for (std::uint32_t i = 0; i < protocol::kMostCandidatesPerMessage; ++i) many.push_back(candidate(100 + i, i));
  offer(phase, port, 0, many, 700, false);
  EXPECT_TRUE(port.take().empty()) << "more follow";
  offer(phase, port, 0, {candidate(5000, 25)}, 700);
  EXPECT_EQ(phase.unshot(), 700) << "said in each message, counted once";
  const auto shots = shots_in(finish_round(phase, port));
  ASSERT_EQ(shots.size(), protocol::kMostCandidatesPerMessage + 1U);
  EXPECT_EQ(shots[0].second.amount[1], 5000);
}

TEST(RadiosityPhase, NoMoreShotsThanAllowed) {
  RadiositySettings limited = settings(2);
  limited.max_shots = 3;
  FakePort port(2);
  RadiosityPhase phase(limited);
  phase.start(port);
  port.take();
  std::vector<std::pair<PeNumber, std::uint32_t>> shots;  // PE, number
  for (const std::int64_t of_pe_1 : {300, 500}) {
    EXPECT_FALSE(phase.done());
    offer(phase, port, 0, {candidate(400, 1)}, 1000);
    offer(phase, port, 1, {candidate(of_pe_1, 9)}, 1000);
    for (const auto& [pe, shoot] : shots_in(finish_round(phase, port))) shots.emplace_back(pe, shoot.number);
  }
  EXPECT_TRUE(phase.done());
  // Two in the first round; of the second round's two the better one.
  EXPECT_EQ(shots, (std::vector<std::pair<PeNumber, std::uint32_t>>{{0, 0}, {1, 1}, {1, 2}}));
  EXPECT_EQ(phase.shots(), 3U);
  EXPECT_EQ(phase.credits_home(), limited.credits);
}

/// One owner with one emitted shot of 64 points, the others with nothing; all asked.
RadiosityPhase one_shot(FakePort& port, RadiositySettings some, PeNumber owner) {
  some.emission_points = 8;
  RadiosityPhase phase(some);
  phase.start(port);
  port.take();
  for (unsigned pe = 0; pe < some.pes; ++pe) {
    offer(phase, port, static_cast<PeNumber>(pe), {}, 1000, pe != owner);
    if (pe == owner) offer(phase, port, owner, {candidate(400, 1, 0, ShotKind::emitted)}, 1000);
  }
  return phase;
}

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
  RadiosityPhase phase(settings(9));
  phase.start(port);
  port.take();
  for (PeNumber pe = 0; pe < 9; ++pe) {
    std::vector<Candidate> candidates;
    if (pe == 3) candidates.push_back(candidate(400, 1, 0, ShotKind::emitted));
    offer(phase, port, pe, candidates, 1000);
  }
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
  some.emission_points = 16;
  RadiosityPhase phase(some);
  phase.start(port);
  port.take();
  for (PeNumber pe = 0; pe < 50; ++pe) {
    std::vector<Candidate> candidates;
    if (pe == 7) candidates.push_back(candidate(400, 1, 0, ShotKind::emitted));
    offer(phase, port, pe, candidates, 1000);
  }
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

TEST(RadiosityPhase, MessagesThatCannotBeAreRefused) {
  FakePort port(1);
  RadiosityPhase phase(settings(1));
  phase.start(port);
  EXPECT_THROW(tell(phase, port, 0, MessageKind::work_done, protocol::WorkDone{1, 5}), MachineFailure)
      << "nothing is dealt yet";
  EXPECT_THROW(tell(phase, port, 0, MessageKind::need), MachineFailure);
  EXPECT_THROW(offer(phase, port, 0, {candidate(100, 30)}, 1000), MachineFailure) << "patch 30 of 30";
  protocol::Candidates cut{};
  cut.count = 3;
  EXPECT_THROW(phase.on_message(port, 0, MessageKind::candidates, std::as_bytes(std::span(&cut, 1)).first(40)),
               MachineFailure);
  offer(phase, port, 0, {candidate(400, 1)}, 1000);
  EXPECT_THROW(tell(phase, port, 0, MessageKind::credits, protocol::Credits{1000}), MachineFailure)
      << "more than were handed out";
  EXPECT_THROW(tell(phase, port, 0, MessageKind::work_done, protocol::WorkDone{3, 5}), MachineFailure)
      << "two parts of a point were dealt";
  EXPECT_THROW(tell(phase, port, 0, MessageKind::work_done, protocol::Credits{1}), MachineFailure) << "too short";
  EXPECT_THROW(tell(phase, port, 0, MessageKind::candidates), MachineFailure) << "while shooting";
}

}  // namespace
}  // namespace torolux::test
