// SPDX-License-Identifier: MIT
// The log of turns that an engine of one thread keeps: of all that the PEs did, in the order in which it was asked for;
// it changes nothing, and other engines keep none.
#include "emulator/engines/engine/turn_log.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/physics/same_picture.hpp"

namespace torolux::test {
namespace {

TEST(TurnLog, HoldsAllTurnsInTheOrderAskedFor) {
  RenderCase cornell = small_cornell();
  cornell.machine.engine = "translated";
  cornell.machine.threads = 1;
  const RenderResult without = run_case(cornell);
  TurnLog log;
  cornell.machine.turns = &log;
  const RenderResult with = run_case(cornell);
  EXPECT_EQ(with.figures.machine.trace_hash, without.figures.machine.trace_hash);

  ASSERT_GT(log.turns.size(), 100U);
  EXPECT_TRUE(std::ranges::is_sorted(log.turns, {}, &Turn::asked));
  for (const Turn& turn : log.turns) {
    ASSERT_GE(turn.ready, 0);
    ASSERT_LE(turn.ready, turn.asked);
    ASSERT_GE(turn.seconds, 0);
  }
  EXPECT_GE(log.own_seconds, log.turns.back().asked);
  EXPECT_TRUE(std::ranges::any_of(log.turns, [](const Turn& turn) { return turn.ready < turn.asked; }));
}

TEST(TurnLog, IsEmptyWhereThreadsShareThePes) {
  RenderCase cornell = small_cornell();
  cornell.machine.engine = "translated";
  cornell.machine.threads = 2;
  TurnLog log;
  cornell.machine.turns = &log;
  run_case(cornell);
  EXPECT_TRUE(log.turns.empty());
}

}  // namespace
}  // namespace torolux::test
