// SPDX-License-Identifier: MIT
// Proves: states to go back to never grow beyond a bound, the last useful one is found, and what a change makes untrue
// is forgotten.
#include <gtest/gtest.h>

#include "emulator/debugger/history.hpp"

namespace torolux::debugger {
namespace {

Position at(std::uint64_t first, std::uint64_t second) {
  return {{{first, false}, {second, false}}};
}

SavedState state(std::uint64_t first, std::uint64_t second, std::size_t bytes = 8) {
  return {at(first, second), 0, std::vector<std::byte>(bytes)};
}

TEST(DebuggerHistory, TheLastStateBeforeAPlaceIsFound) {
  History history;
  for (const std::uint64_t steps : {10U, 20U, 30U}) history.keep(state(steps, steps));
  EXPECT_EQ(history.before(at(30, 30))->position.places[0].steps, 20U);
  EXPECT_EQ(history.before(at(30, 31))->position.places[0].steps, 30U);
  EXPECT_EQ(history.before(at(100, 25))->position.places[0].steps, 20U);
  EXPECT_EQ(history.before(at(5, 100)), nullptr);
  EXPECT_EQ(history.before(at(30, 31), 0, 30)->position.places[0].steps, 20U);
  EXPECT_EQ(history.before(at(30, 31), 0, 10), nullptr);
}

TEST(DebuggerHistory, StatesAreThinnedOut) {
  History history;
  std::uint64_t steps = 0;
  for (int i = 0; i < 100; ++i) {
    while (!history.is_due(steps)) steps += 100'000;
    history.keep(state(steps / 2, steps / 2));
    EXPECT_LE(history.states(), 32U);
  }
  EXPECT_GE(history.states(), 16U);
  History large;
  for (std::uint64_t i = 1; i < 20; ++i) large.keep(state(i, i, std::size_t{100} << 20U));
  EXPECT_LE(large.states(), 5U);
}

TEST(DebuggerHistory, AChangeForgetsWhatComesBehind) {
  History history;
  for (const std::uint64_t steps : {10U, 20U, 30U}) history.keep(state(steps, steps));
  history.forget_behind(at(20, 25), 0);  // the PE stands as in the second state, which lacks the change
  EXPECT_EQ(history.states(), 1U);
  EXPECT_EQ(history.before(at(100, 100))->position.places[0].steps, 10U);
}

}  // namespace
}  // namespace torolux::debugger
