// SPDX-License-Identifier: MIT
// Proves: with grains of one cycle states are told as they were; with wider ones, at most one change for each grain,
// and each state's share of the time is right to within two grains.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include "emulator/niu/state_tally.hpp"

namespace torolux {
namespace {

constexpr std::size_t kStates = 5;
using Changes = std::vector<std::pair<std::uint64_t, std::size_t>>;

auto into(Changes& changes) {
  return [&changes](std::uint64_t begin, std::size_t state) {
    changes.emplace_back(begin, state);
    return true;
  };
}

TEST(StateTally, GrainsOfOneCycleTellAll) {
  StateTally<kStates> tally{};
  Changes told;
  tally.account(3, 1, into(told));
  tally.account(4, 0, into(told));
  tally.account(4, 3, into(told));  // lasts for no time
  tally.account(1000, 2, into(told));
  tally.account(2000, 2, into(told));
  tally.account(2001, 1, into(told));
  tally.finish(into(told));
  EXPECT_EQ(told, (Changes{{0, 1}, {3, 0}, {4, 2}, {2000, 1}}));
  EXPECT_EQ(tally.until(), 2001U);
}

TEST(StateTally, SharesAreRightHoweverShortTheTurns) {
  constexpr std::uint32_t kShift = 8;
  StateTally<kStates> tally{};
  tally.set_shift(kShift);
  Changes told;
  std::array<double, kStates> lasted{}, shown{};
  std::mt19937 random(3);  // the same numbers on any computer
  std::uint64_t time = 0;
  for (int i = 0; i < 100000; ++i) {
    const std::size_t state = random() % kStates;
    const std::uint64_t length = 1 + random() % (10 * (state + 1));
    time += length;
    lasted[state] += static_cast<double>(length);
    tally.account(time, state, into(told));
  }
  tally.finish(into(told));
  for (std::size_t i = 0; i < told.size(); ++i) {
    const std::uint64_t end = i + 1 < told.size() ? told[i + 1].first : time;
    EXPECT_LT(told[i].first, end);
    EXPECT_EQ(told[i].first % (1U << kShift), 0U);
    shown[told[i].second] += static_cast<double>(end - told[i].first);
  }
  // What is owed to all states together is nothing at the end of a grain, and who gets a grain is owed something: so
  // nobody is ahead by a grain, nor, there being four others, behind by more than four; here by less than two.
  for (std::size_t state = 0; state < kStates; ++state)
    EXPECT_LT(std::abs(shown[state] - lasted[state]), 2 << kShift) << state;
}

TEST(StateTally, WholeGrainsAreWhereTheyWere) {
  StateTally<kStates> tally{};
  tally.set_shift(4);
  Changes told;
  tally.account(10, 1, into(told));
  tally.account(20, 2, into(told));
  tally.account(100, 3, into(told));
  EXPECT_EQ(told, (Changes{{0, 1}, {16, 3}}));
  tally.finish(into(told));  // state 2 has had ten cycles, and no grain yet
  EXPECT_EQ(told, (Changes{{0, 1}, {16, 3}, {96, 2}}));
}

TEST(StateTally, WhatIsNotTakenIsToldAgain) {
  StateTally<kStates> tally{};
  Changes told;
  const auto refuse = [](std::uint64_t, std::size_t) { return false; };
  tally.account(5, 1, into(told));
  tally.account(9, 2, refuse);
  tally.account(12, 2, into(told));
  EXPECT_EQ(told, (Changes{{0, 1}, {9, 2}}));
}

}  // namespace
}  // namespace torolux
