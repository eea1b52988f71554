// SPDX-License-Identifier: MIT
// What a log of turns says of more cores: what is independent runs side by side, what waits for each other does not,
// and nothing is ever faster than its longest part.
#include "host_tools/bench/predicted_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace torolux {
namespace {

/// Sums of a few doubles of about 1.
constexpr double kRounding = 1e-9;

TEST(PredictedTime, OneCoreTakesWhatWasMeasured) {
  const TurnLog log{{{0, 1, 2}, {0.5, 1, 3}, {1, 4, 1}}, 5};
  EXPECT_NEAR(predicted_seconds(log, 1), 11, kRounding);
  EXPECT_NEAR(measured_seconds(log), 11, kRounding);
}

// Four turns of a second, ready from the beginning, while the scheduler handles events for a second. Threads leave it
// the last one.
TEST(PredictedTime, IndependentTurnsRunSideBySide) {
  const TurnLog log{{{0, 1, 1}, {0, 1, 1}, {0, 1, 1}, {0, 1, 1}}, 1};
  EXPECT_NEAR(predicted_seconds(log, 1), 5, kRounding);
  EXPECT_NEAR(predicted_seconds(log, 2), 3, kRounding);
  EXPECT_NEAR(predicted_seconds(log, 4), 2, kRounding);
  EXPECT_NEAR(predicted_seconds(log, 64), 2, kRounding);
}

// Each is ready only when it is asked for.
TEST(PredictedTime, AChainGainsNothing) {
  const TurnLog log{{{0, 0, 1}, {1, 1, 1}, {2, 2, 1}}, 3};
  EXPECT_NEAR(predicted_seconds(log, 64), 6, kRounding);
}

// While the scheduler handles events for a second, another thread runs what is asked for then, and one more is left.
TEST(PredictedTime, EventsAndTurnsOverlap) {
  const TurnLog log{{{0, 1, 1}, {0, 1, 0.25}}, 1};
  EXPECT_NEAR(predicted_seconds(log, 2), 1.25, kRounding);
}

// The second is asked for first, while the one thread is busy with the first until 10: the scheduler runs it itself.
TEST(PredictedTime, TheSchedulerRunsWhatNobodyHasBegun) {
  const TurnLog log{{{1, 1, 2}, {0, 4, 10}, {1, 5, 0}}, 5};
  EXPECT_NEAR(predicted_seconds(log, 2), 11, kRounding);
}

// Each rank has its own PEs; what is asked for is known a message to and a message back later.
TEST(PredictedTime, RanksRunTheirOwnBlocks) {
  const TurnLog apart{{{0, 1, 1, 0}, {0, 1, 1, 3}}, 1};
  EXPECT_NEAR(predicted_on_ranks(apart, 3, 0), 1, kRounding);
  EXPECT_NEAR(predicted_on_ranks(apart, 2, 0), 2, kRounding);
  EXPECT_NEAR(predicted_on_ranks(apart, 3, 0.25), 1.5, kRounding);
  const TurnLog together{{{0, 1, 1, 2}, {0, 1, 1, 3}}, 1};
  EXPECT_NEAR(predicted_on_ranks(together, 3, 0), 2, kRounding);
}

// Graham 1966: no list schedule is faster than the sum over all cores, or than a chain of what waits for each other;
// nor slower than one core.
TEST(PredictedTime, StaysWithinTheBoundsOfListScheduling) {
  std::mt19937 random(19);
  std::uniform_real_distribution<double> number(0, 1);
  for (int run = 0; run < 200; ++run) {
    TurnLog log;
    double asked = 0;
    double longest = 0;
    for (int turn = 0; turn < 50; ++turn) {
      asked += 0.1 * number(random);
      log.turns.push_back({asked * number(random), asked, number(random)});
      longest = std::max(longest, log.turns.back().seconds);
    }
    log.own_seconds = asked + number(random);
    const double all = measured_seconds(log);
    for (const unsigned cores : {1U, 2U, 3U, 8U, 64U}) {
      const double seconds = predicted_seconds(log, cores);
      EXPECT_GE(seconds, std::max({log.own_seconds, longest, all / cores}) - kRounding) << run << " " << cores;
      EXPECT_LE(seconds, all + kRounding) << run << " " << cores;
    }
  }
}

}  // namespace
}  // namespace torolux
