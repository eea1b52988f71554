// SPDX-License-Identifier: MIT
// The host's conduct of the radiosity stage: whom it lets shoot and how much, how credits go out and come home, and
// when it ends. PEs are the test itself, so each message can come at any moment.
#include "host_tools/stages/radiosity_phase.hpp"

#include <gtest/gtest.h>

#include <map>
#include <random>

#include "firmware/protocol/flux.hpp"
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

/// Credits granted, by PE.
std::map<PeNumber, std::uint32_t> grants_in(const std::vector<Sent>& sent) {
  std::map<PeNumber, std::uint32_t> grants;
  for (const Sent& one : sent) {
    if (one.is(MessageKind::grant)) grants[one.pe] += one.as<protocol::Grant>().credits;
  }
  return grants;
}

/// The shots of the first round by their number, however PEs answer: each shot ends before the next message.
std::map<std::uint32_t, std::pair<PeNumber, Shoot>> first_round(const std::vector<std::vector<Candidate>>& offers,
                                                                const std::vector<PeNumber>& order) {
  FakePort port(3);
  RadiosityPhase phase(settings(3));
  phase.start(port);
  for (const PeNumber pe : order) offer(phase, port, pe, offers[pe], 1000);
  std::map<std::uint32_t, std::pair<PeNumber, Shoot>> shots;
  for (std::vector<Sent> sent = port.take(); !shots_in(sent).empty(); sent = port.take()) {
    for (const auto& [pe, shoot] : shots_in(sent)) shots[shoot.number] = {pe, shoot};
    for (const auto& [pe, shoot] : shots_in(sent)) tell(phase, port, pe, MessageKind::shot_done, protocol::ShotDone{5});
  }
  return shots;
}

TEST(RadiosityPhase, AsksAllPesForTheirBest) {
  FakePort port(3);
  RadiosityPhase phase(settings(3));
  phase.start(port);
  const auto sent = port.take();
  ASSERT_EQ(sent.size(), 3U);
  for (PeNumber pe = 0; pe < 3; ++pe) {
    EXPECT_EQ(sent[pe].pe, pe);
    ASSERT_TRUE(sent[pe].is(MessageKind::select));
    EXPECT_EQ(sent[pe].as<protocol::Select>().count, 4U);
    EXPECT_EQ(sent[pe].as<protocol::Select>().threshold, 7);
  }
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
  // Five are sorted: 5 x 3. Of the best four the first of each PE begins: found as number 0 and 2 of the choice.
  EXPECT_EQ(port.done(HostWork::compare), 15U + 1 + 3);
  // A grant to each of two shooters; behind the shot it is the second thing under way there, so both are passed over.
  EXPECT_EQ(port.done(HostWork::entry), 5U + 4);
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

TEST(RadiosityPhase, SumsOfFluxShotAreThoseOfTheAmounts) {
  FakePort port(1);
  RadiosityPhase phase(settings(1));
  phase.start(port);
  offer(phase, port, 0, {candidate(400, 1), candidate(300, 2, 0, ShotKind::emitted)}, 1000);
  EXPECT_EQ(shots_in(port.take()).size(), 1U) << "one shot at a time from each PE";
  tell(phase, port, 0, MessageKind::shot_done, protocol::ShotDone{5});
  EXPECT_EQ(shots_in(port.take()).size(), 1U);
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
  const auto shots = shots_in(port.take());
  ASSERT_EQ(shots.size(), 1U);
  EXPECT_EQ(shots[0].second.amount[1], 5000);
}

TEST(RadiosityPhase, NoMoreShotsThanAllowed) {
  RadiositySettings limited = settings(2);
  limited.max_shots = 3;
  FakePort port(2);
  RadiosityPhase phase(limited);
  phase.start(port);
  std::vector<std::pair<PeNumber, std::uint32_t>> shots;  // PE, number
  for (const std::int64_t of_pe_1 : {300, 500}) {
    EXPECT_FALSE(phase.done());
    offer(phase, port, 0, {candidate(400, 1)}, 1000);
    offer(phase, port, 1, {candidate(of_pe_1, 9)}, 1000);
    const auto sent = port.take();
    for (const auto& [pe, shoot] : shots_in(sent)) shots.emplace_back(pe, shoot.number);
    for (const auto& [pe, credits] : grants_in(sent)) tell(phase, port, pe, MessageKind::credits, credits);
    // Meanwhile more were granted; they come home unused.
    const auto more = grants_in(port.take());
    for (const auto& [pe, shoot] : shots_in(sent)) tell(phase, port, pe, MessageKind::shot_done, protocol::ShotDone{5});
    for (const auto& [pe, credits] : more) tell(phase, port, pe, MessageKind::credits, credits);
    for (const auto& [pe, credits] : grants_in(port.take())) tell(phase, port, pe, MessageKind::credits, credits);
  }
  EXPECT_TRUE(phase.done());
  // Two in the first round; of the second round's two the better one.
  EXPECT_EQ(shots, (std::vector<std::pair<PeNumber, std::uint32_t>>{{0, 0}, {1, 1}, {1, 2}}));
  EXPECT_EQ(phase.shots(), 3U);
  EXPECT_EQ(phase.credits_home(), limited.credits);
}

/// PEs that shoot at random: they turn some of their credits into records, which die at once.
class RandomPes {
 public:
  RandomPes(RadiosityPhase& phase, FakePort& port, std::uint32_t seed) : phase_(phase), port_(port), random_(seed) {}

  /// Until the host selects again. Checks each step.
  void shoot_until_the_round_ends(std::uint64_t credits) {
    for (int step = 0; listen(); ++step) {
      ASSERT_LT(step, 100'000);
      ASSERT_EQ(out_ + phase_.credits_home(), credits);
      act(static_cast<PeNumber>(random_() % 3));
    }
    EXPECT_EQ(out_, 0U);
  }
  std::uint64_t shots() const { return shots_; }

 private:
  /// What the host has sent; false: a new selection.
  bool listen() {
    for (const Sent& sent : port_.take()) {
      if (sent.is(MessageKind::select)) return false;
      if (sent.is(MessageKind::shoot)) {
        EXPECT_EQ(shooting_.count(sent.pe), 0U) << "a shot while another is in progress";
        shooting_[sent.pe] = 1 + random_() % 400;
        ++shots_;
      } else {
        EXPECT_TRUE(sent.is(MessageKind::grant));
        EXPECT_EQ(shooting_.count(sent.pe), 1U) << "credits for a PE that does not shoot";
        held_[sent.pe] += sent.as<protocol::Grant>().credits;
        out_ += sent.as<protocol::Grant>().credits;
      }
    }
    return true;
  }

  void act(PeNumber pe) {
    if (const auto shot = shooting_.find(pe); shot != shooting_.end() && shot->second == 0) {
      shooting_.erase(shot);
      tell(phase_, port_, pe, MessageKind::shot_done, protocol::ShotDone{5});
    } else if (held_[pe] > 0) {
      const std::uint64_t used = std::min<std::uint64_t>(held_[pe], 1 + random_() % 64);
      if (shot != shooting_.end()) shot->second -= std::min(shot->second, used);
      held_[pe] -= used;
      out_ -= used;
      tell(phase_, port_, pe, MessageKind::credits, protocol::Credits{static_cast<std::uint32_t>(used)});
    }
  }

  RadiosityPhase& phase_;
  FakePort& port_;
  std::minstd_rand random_;
  std::map<PeNumber, std::uint64_t> shooting_;  ///< records that the shot in progress still has to make
  std::map<PeNumber, std::uint64_t> held_;      ///< credits granted and not home
  std::uint64_t out_ = 0;                       ///< their sum
  std::uint64_t shots_ = 0;
};

TEST(RadiosityPhase, CreditsAreNeverMoreThanThereAreAndAllComeHome) {
  for (std::uint32_t seed = 1; seed <= 200; ++seed) {
    FakePort port(3);
    RadiositySettings some = settings(3);
    some.credits = 1 + seed * 37 % 300;
    RadiosityPhase phase(some);
    phase.start(port);
    port.take();
    for (const std::uint32_t pe : {1U, 0U, 2U}) {
      offer(phase, port, static_cast<PeNumber>(pe), {candidate(100 + pe, pe), candidate(90, pe + 10)}, 1000);
    }
    RandomPes pes(phase, port, seed);
    pes.shoot_until_the_round_ends(some.credits);
    EXPECT_EQ(pes.shots(), 4U) << "seed " << seed;
    EXPECT_EQ(phase.shots(), 4U);
    EXPECT_EQ(phase.credits_home(), some.credits);
  }
}

TEST(RadiosityPhase, APeWithGrantsUnderWayIsPassedOver) {
  FakePort port(2);
  RadiosityPhase phase(settings(2));
  phase.start(port);
  port.take();
  offer(phase, port, 0, {candidate(400, 1)}, 1000);
  offer(phase, port, 1, {candidate(300, 2)}, 1000);
  const auto grants = grants_in(port.take());
  ASSERT_EQ(grants.size(), 2U) << "each gets some, none all";
  EXPECT_LE(grants.at(0) + grants.at(1), 100U);
  EXPECT_GT(phase.credits_home(), 0U) << "held back: two messages wait for each";
}

TEST(RadiosityPhase, MessagesThatCannotBeAreRefused) {
  FakePort port(1);
  RadiosityPhase phase(settings(1));
  phase.start(port);
  EXPECT_THROW(tell(phase, port, 0, MessageKind::shot_done, protocol::ShotDone{5}), MachineFailure)
      << "nothing shoots yet";
  EXPECT_THROW(offer(phase, port, 0, {candidate(100, 30)}, 1000), MachineFailure) << "patch 30 of 30";
  protocol::Candidates cut{};
  cut.count = 3;
  EXPECT_THROW(phase.on_message(port, 0, MessageKind::candidates, std::as_bytes(std::span(&cut, 1)).first(40)),
               MachineFailure);
  offer(phase, port, 0, {candidate(400, 1)}, 1000);
  EXPECT_THROW(tell(phase, port, 0, MessageKind::credits, protocol::Credits{1000}), MachineFailure)
      << "more than were handed out";
  EXPECT_THROW(tell(phase, port, 0, MessageKind::candidates), MachineFailure) << "while shooting";
}

}  // namespace
}  // namespace torolux::test
