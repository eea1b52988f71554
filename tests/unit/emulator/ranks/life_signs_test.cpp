// SPDX-License-Identifier: MIT
// Proves: who says nothing any more is noticed, who computes without a look at messages is not taken for that, and
// one's own sleep is not blamed on others.
#include "emulator/ranks/life_signs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>

#include "emulator/ranks/thread_ranks.hpp"

namespace torolux::ranks {
namespace {

using std::chrono_literals::operator""ms;
using testing::Each;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr LifeTimes kTimes{5ms, 3000ms};
constexpr std::uint32_t kWord = 7;

// Rank 1 is dead after one message; rank 2 computes until the end, and its thread alone speaks.
TEST(LifeSigns, TellTheDeadFromTheBusy) {
  std::atomic<bool> done = false;
  const auto ends = run_as_threads(3, {}, [&](Transport& transport) {
    const unsigned own = transport.ranks().own;
    if (own == 1) {
      transport.send(0, kWord, {});
    } else if (own == 2) {
      const LifeSigns life(transport, {0}, kTimes);
      while (!done) std::this_thread::sleep_for(1ms);
    } else {
      LifeSigns life(transport, {1, 2}, kTimes);
      unsigned words = 0;
      while (life.silent_ones().empty()) {
        while (const auto message = life.poll()) {
          EXPECT_EQ(message->kind, kWord) << "signs of life are not for the reader";
          ++words;
        }
        transport.wait(10ms);
      }
      EXPECT_EQ(words, 1U);
      EXPECT_THAT(life.silent_ones(), ElementsAre(1U));
      done = true;
    }
  });
  EXPECT_THAT(ends, Each(IsEmpty()));
}

TEST(LifeSigns, WhoIsHeardAgainIsNotSilent) {
  std::atomic<bool> silent = false;
  const auto ends = run_as_threads(2, {}, [&](Transport& transport) {
    if (transport.ranks().own == 1) {
      while (!silent) std::this_thread::sleep_for(1ms);
      transport.send(0, kWord, {});
    } else {
      LifeSigns life(transport, {1}, {1ms, 50ms});
      while (!life.silent(1)) {
        EXPECT_FALSE(life.poll());
        std::this_thread::sleep_for(1ms);
      }
      silent = true;
      while (!life.poll()) std::this_thread::sleep_for(1ms);
      EXPECT_FALSE(life.silent(1));
    }
  });
  EXPECT_THAT(ends, Each(IsEmpty()));
}

// As after SIGSTOP: of ten times the limit, an eighth counts.
TEST(LifeSigns, OnesOwnSleepIsNotTheOthersSilence) {
  const auto ends = run_as_threads(2, {}, [&](Transport& transport) {
    if (transport.ranks().own == 1) return;
    LifeSigns life(transport, {1}, {1ms, 20ms});
    std::this_thread::sleep_for(200ms);
    EXPECT_FALSE(life.poll());
    EXPECT_FALSE(life.silent(1));
  });
  EXPECT_THAT(ends, Each(IsEmpty()));
}

TEST(LifeSigns, EndWithTheTransport) {
  const auto ends = run_as_threads(2, {}, [&](Transport& transport) {
    LifeSigns life(transport, {1 - transport.ranks().own}, {1ms, 3000ms});
    if (transport.ranks().own == 1) transport.abort("enough");
    for (;;) {
      life.poll();
      transport.wait(1ms);
    }
  });
  EXPECT_THAT(ends, Each(HasSubstr("rank 1: enough")));
}

}  // namespace
}  // namespace torolux::ranks
