// SPDX-License-Identifier: MIT
// Final gathering as the host conducts it: when it begins, who is told what, when the stage is over.
#include "tests/unit/host_tools/stages/radiosity_messages.hpp"

namespace torolux::test {
namespace {

RadiositySettings gathering_settings() {
  RadiositySettings some = settings(2);
  some.gatherings = {{1, 4, 12, 1, 3}, {0, 2, 6, 0, 2}};
  return some;
}

void expect_gatherings(const std::vector<Sent>& sent) {
  const auto shots = shots_in(sent);
  ASSERT_EQ(shots.size(), 2U);
  for (const auto& [pe, shoot] : shots) {
    EXPECT_EQ(shoot.kind, ShotKind::gathering);
    EXPECT_EQ(shoot.amount, (protocol::Flux{pe == 1 ? 3 : 2, 0, 0}));
    EXPECT_EQ(shoot.patch, pe == 1 ? 4U : 2U);
    EXPECT_EQ(shoot.side, pe == 1 ? 1U : 0U);
  }
  std::uint32_t dealt = 0;
  for (const Piece& piece : pieces_in(sent)) dealt += piece.of_point;
  EXPECT_EQ(dealt, 5U * protocol::kPointParts) << "all points, whole or in parts";
}

/// All PEs have nothing to shoot.
void offer_nothing(RadiosityPhase& phase, FakePort& port) {
  for (PeNumber pe = 0; pe < 2; ++pe) offer(phase, port, pe, {}, 0);
}

// Elements gather when nothing is left to shoot, once, and the stage ends when their rays are home.
TEST(RadiosityPhase, GathersWhenNothingIsLeftToShoot) {
  FakePort port(2);
  RadiosityPhase phase(gathering_settings());
  phase.start(port);
  port.take();
  EXPECT_EQ(phase.gathered(), 0) << "not begun";
  offer_nothing(phase, port);
  EXPECT_FALSE(phase.done());
  EXPECT_LT(phase.gathered(), 1);
  expect_gatherings(finish_round(phase, port));
  EXPECT_EQ(phase.gathered(), 1);
  EXPECT_TRUE(phase.done());
  ASSERT_EQ(phase.rounds().size(), 1U);
  EXPECT_EQ(phase.rounds().back().shooters, 2U);
  EXPECT_GT(phase.rounds().back().records, 0U);
  EXPECT_EQ(phase.shots(), 0U) << "no light was shot";
  EXPECT_EQ(phase.emitted_shot(), protocol::Flux{});
}

// Behind a round of shots, too; and where no more shots are allowed, without another selection.
TEST(RadiosityPhase, GathersBehindTheLastShots) {
  for (const std::uint32_t max_shots : {0U, 1U}) {
    FakePort port(2);
    RadiositySettings some = gathering_settings();
    some.max_shots = max_shots;
    RadiosityPhase phase = one_shot(port, some, 1, 1);
    std::vector<Sent> sent = finish_round(phase, port);
    if (max_shots == 0) {
      ASSERT_FALSE(phase.done());
      offer_nothing(phase, port);
      sent = finish_round(phase, port);
    } else {
      const auto first = std::find_if(sent.begin(), sent.end(), [](const Sent& one) {
        return one.is(MessageKind::shoot) && one.as<Shoot>().kind == ShotKind::gathering;
      });
      sent.erase(sent.begin(), first);
    }
    expect_gatherings(sent);
    EXPECT_TRUE(phase.done()) << max_shots;
    EXPECT_EQ(phase.shots(), 1U);
    EXPECT_EQ(phase.rounds().size(), 2U);
  }
}

// Without any, the stage ends as soon as nothing is left.
TEST(RadiosityPhase, EndsAtOnceWhereNothingGathers) {
  FakePort port(2);
  RadiosityPhase phase(settings(2));
  phase.start(port);
  port.take();
  offer_nothing(phase, port);
  EXPECT_TRUE(phase.done());
}

}  // namespace
}  // namespace torolux::test
