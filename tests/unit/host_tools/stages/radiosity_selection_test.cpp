// SPDX-License-Identifier: MIT
// The host's choice of shooters in the radiosity stage: whom it lets shoot and how much, and when the stage ends.
#include "tests/unit/host_tools/stages/radiosity_messages.hpp"

namespace torolux::test {
namespace {

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
