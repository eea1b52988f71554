// SPDX-License-Identifier: MIT
// The shadow call stack, told of one jump after the other: calls, returns and all that looks like neither.
#include "emulator/profile/pe_profile.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>

namespace torolux::profile {
namespace {

using testing::ElementsAre;
using testing::Pair;

constexpr std::uint32_t kStack = 0x8000'8000U;

/// A program of functions a .. f, of 16 bytes each from 0x80000000 on, and __riscv_restore_0 behind them. Each jump
/// takes the function that it leaves 10 cycles.
class Jumps : public testing::Test {
 protected:
  static constexpr std::uint32_t at(char function, std::uint32_t offset = 0) {
    return 0x8000'0000U + 16U * static_cast<std::uint32_t>(function - 'a') + offset;
  }
  static constexpr char kRestore = 'g';

  Jumps() { profile_.begin({at('a'), kStack, 0}, {}); }

  void go(Flow flow, std::uint32_t to, std::uint32_t stack = kStack) {
    clock_ += 10;
    profile_.executed(flow, {to, stack, clock_}, link_);
  }
  /// Returns to `link`.
  void call(char function, std::uint32_t link, std::uint32_t stack = kStack) {
    link_ = link;
    go(Flow::call, at(function), stack);
  }
  /// Path and its own cycles, of all paths that have been entered.
  std::map<std::string, std::uint64_t> cycles() const {
    return all([](const CallNode& node) { return node.self; });
  }
  std::map<std::string, std::uint64_t> calls() const {
    return all([](const CallNode& node) { return node.calls; });
  }

  template <class Take>
  std::map<std::string, std::uint64_t> all(Take take) const {
    std::map<std::string, std::uint64_t> result;
    const std::vector<CallNode>& nodes = profile_.tree().nodes();
    std::vector<std::string> paths(nodes.size());
    for (std::size_t i = 1; i < nodes.size(); ++i) {
      paths[i] = paths[nodes[i].parent] + functions_.name(nodes[i].function).substr(0, 9);
      result[paths[i]] = take(nodes[i]);
    }
    return result;
  }

  static Image image() {
    Image image;
    image.segments = {{at('a'), 0x100, {}, true, false}};
    for (const char* name = "abcdef"; *name != 0; ++name)
      image.symbols.push_back({at(*name), 16, std::string(1, *name), true});
    image.symbols.push_back({at(kRestore), 16, "__riscv_restore_0", true});
    return image;
  }

  FunctionTable functions_{image()};
  PeProfile profile_{functions_};
  std::uint64_t clock_ = 0;
  std::uint32_t link_ = 0;
};

TEST_F(Jumps, CallAndReturn) {
  call('b', at('a', 4));
  call('c', at('b', 4), kStack - 16);
  go(Flow::back, at('b', 4), kStack - 16);
  go(Flow::back, at('a', 4));
  call('c', at('a', 8));
  go(Flow::back, at('a', 8));
  profile_.charge(clock_ + 5);
  EXPECT_THAT(cycles(), ElementsAre(Pair("a", 25), Pair("ab", 20), Pair("abc", 10), Pair("ac", 10)));
  EXPECT_THAT(calls(), ElementsAre(Pair("a", 1), Pair("ab", 1), Pair("abc", 1), Pair("ac", 1)));
}

TEST_F(Jumps, RecursionIsALongerPath) {
  call('b', at('a', 4));
  call('b', at('b', 4), kStack - 16);
  call('b', at('b', 4), kStack - 32);
  go(Flow::back, at('b', 4), kStack - 32);
  go(Flow::back, at('b', 4), kStack - 16);
  go(Flow::back, at('a', 4));
  EXPECT_THAT(cycles(), ElementsAre(Pair("a", 10), Pair("ab", 20), Pair("abb", 20), Pair("abbb", 10)));
}

TEST_F(Jumps, ATailCallTakesThePlaceOfItsCaller) {
  call('b', at('a', 4));
  go(Flow::on, at('c'));
  go(Flow::back, at('a', 4));
  call('d', at('a', 8));
  EXPECT_THAT(calls(), ElementsAre(Pair("a", 1), Pair("ab", 1), Pair("ac", 1), Pair("ad", 1)));
}

TEST_F(Jumps, IntoTheMiddleOfAFunctionIsNoCall) {
  call('b', at('a', 4));
  go(Flow::on, at('c', 4));
  EXPECT_THAT(calls(), ElementsAre(Pair("a", 1), Pair("ab", 1), Pair("ac", 0)));
}

TEST_F(Jumps, AHelperOfTheSameFunctionIsAPartOfIt) {
  call('b', at('a', 4));
  link_ = at('b', 4);
  go(Flow::call, at('b', 8));
  go(Flow::back, at('b', 4));
  go(Flow::back, at('a', 4));
  EXPECT_THAT(cycles(), ElementsAre(Pair("a", 10), Pair("ab", 30)));
}

TEST_F(Jumps, RegistersAreRestoredUnderTheFunctionThatSavedThem) {
  call('b', at('a', 4));
  go(Flow::on, at(kRestore), kStack - 16);
  go(Flow::back, at('a', 4));
  call('c', at('a', 8));
  EXPECT_THAT(calls(), ElementsAre(Pair("a", 1), Pair("ab", 1), Pair("ab__riscv_r", 1), Pair("ac", 1)));
}

TEST_F(Jumps, LongjmpLeavesWhatIsAboveItsTarget) {
  call('b', at('a', 4));
  call('c', at('b', 4), kStack - 16);
  call('c', at('c', 4), kStack - 32);
  call('d', at('c', 4), kStack - 48);
  go(Flow::back, at('b', 8), kStack - 16);  // no call has this for its return address
  call('e', at('b', 12), kStack - 16);
  EXPECT_EQ(calls().count("abe"), 1U);
}

TEST_F(Jumps, LongjmpFindsTheRightOneOfSeveralCalls) {
  call('b', at('a', 4));
  call('b', at('b', 4), kStack - 16);
  call('b', at('b', 4), kStack - 32);
  call('c', at('b', 4), kStack - 48);
  go(Flow::back, at('b', 8), kStack - 32);
  call('e', at('b', 12), kStack - 32);
  EXPECT_EQ(calls().count("abbe"), 1U) << "the second b had its stack from kStack - 16 on";
}

TEST_F(Jumps, AnotherStackLeavesNothing) {
  constexpr std::uint32_t kOther = kStack + 0x1000;
  call('b', at('a', 4));
  call('c', at('b', 4), kStack - 16);  // c switches stacks
  go(Flow::back, at('d', 0), kOther);  // to d, which has never been called
  call('c', at('d', 4), kOther - 16);  // d goes back the same way
  go(Flow::back, at('b', 4), kStack - 16);
  call('e', at('b', 8), kStack - 16);
  EXPECT_THAT(calls(), ElementsAre(Pair("a", 1), Pair("ab", 1), Pair("abc", 1), Pair("abd", 1), Pair("abdc", 1),
                                   Pair("abe", 1)));
}

TEST_F(Jumps, ATrapReturnsToWhereItCameFrom) {
  call('b', at('a', 4));
  go(Flow::trap, at('f'));
  call('e', at('f', 4));
  go(Flow::back, at('f', 4));
  go(Flow::trap_return, at('b', 4));
  go(Flow::back, at('a', 4));
  EXPECT_THAT(cycles(), ElementsAre(Pair("a", 10), Pair("ab", 20), Pair("abf", 20), Pair("abfe", 10)));
  EXPECT_EQ(calls()["abf"], 1U);
}

TEST_F(Jumps, TwoRoutinesThatCallEachOtherStayBesideEachOther) {
  call('b', at('a', 4));
  for (int i = 0; i < 1000; ++i) {
    link_ = at('b', 4);
    go(Flow::swap, at('c'));
    link_ = at('c', 4);
    go(Flow::swap, at('b', 4));
  }
  for (const auto& [path, unused] : cycles()) EXPECT_LE(path.size(), 4U) << path;
}

TEST_F(Jumps, CallsThatNeverReturnDoNotPileUp) {
  for (int i = 0; i < 1000; ++i) {
    call('b', at('a', 4));
    go(Flow::on, at('a', 0));  // by a jump
  }
  for (const auto& [path, unused] : cycles()) EXPECT_LE(path.size(), 2U) << path;
}

TEST_F(Jumps, AReturnFromTheFirstFunctionGoesOnElsewhere) {
  go(Flow::back, at('d', 4));
  profile_.charge(clock_ + 3);
  EXPECT_THAT(cycles(), ElementsAre(Pair("a", 10), Pair("d", 3)));
}

TEST_F(Jumps, WaitsAreNotCyclesOfTheFunction) {
  call('b', at('a', 4));
  clock_ += 4;
  clock_ += 100;
  profile_.waited({70, 0, 30, 0});
  profile_.charge(clock_);
  EXPECT_THAT(cycles(), ElementsAre(Pair("a", 10), Pair("ab", 4)));
  EXPECT_THAT(all([](const CallNode& node) { return node.waits[0]; }), ElementsAre(Pair("a", 0), Pair("ab", 70)));
  EXPECT_THAT(all([](const CallNode& node) { return node.waits[2]; }), ElementsAre(Pair("a", 0), Pair("ab", 30)));
}

TEST_F(Jumps, PathsBeyondTheLongestAreCutAndNoCycleIsLost) {
  for (std::uint32_t depth = 1; depth <= 2 * kLongestPath; ++depth) call('b', at('b', 4), kStack - 16 * depth);
  EXPECT_TRUE(profile_.tree().is_cut());
  EXPECT_LE(profile_.tree().nodes().size(), kLongestPath + 3);
  std::uint64_t sum = 0, called = 0;
  for (const CallNode& node : profile_.tree().nodes()) sum += node.self, called += node.calls;
  EXPECT_EQ(sum, clock_);
  EXPECT_EQ(called, 2 * kLongestPath + 1);
}

}  // namespace
}  // namespace torolux::profile
