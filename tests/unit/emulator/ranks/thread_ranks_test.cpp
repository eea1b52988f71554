// SPDX-License-Identifier: MIT
// Proves of the transport by threads, whatever its delays: messages arrive whole, once and in order between each pair;
// waiting ends with a message or with its limit; one rank can end all; closing waits for all but the lost.
#include "emulator/ranks/thread_ranks.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <map>

namespace torolux::ranks {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""us;
using testing::Each;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr unsigned kMessages = 200;

std::vector<std::byte> some_bytes(unsigned from, unsigned number) {
  return std::vector<std::byte>(number % 7, static_cast<std::byte>(from * 31 + number));
}

/// Kinds change, and order holds across them.
std::uint32_t some_kind(unsigned number) {
  return 1 + number * 7919 % kMostKind;
}

Message next_message(Transport& transport) {
  for (;;) {
    if (std::optional<Message> message = transport.poll()) return std::move(*message);
    transport.wait(1000ms);
  }
}

void talk_to_all(Transport& transport) {
  const auto [own, count] = transport.ranks();
  for (unsigned number = 0; number < kMessages; ++number) {
    for (unsigned to = 0; to < count; ++to) transport.send(to, some_kind(number), some_bytes(own, number));
  }
  std::map<unsigned, unsigned> next;
  for (unsigned received = 0; received < kMessages * count; ++received) {
    const Message message = next_message(transport);
    const unsigned number = next[message.from]++;
    EXPECT_EQ(message.kind, some_kind(number)) << "from " << message.from << ", message " << number;
    EXPECT_EQ(message.bytes, some_bytes(message.from, number));
  }
  EXPECT_FALSE(transport.poll()) << "a message has come twice";
  transport.close({}, 0);
}

TEST(ThreadRanks, KeepOrderBetweenEachPairWhateverTheDelays) {
  for (const unsigned count : {1U, 2U, 3U, 5U}) {
    for (const std::uint64_t seed : {1U, 2U, 3U})
      EXPECT_THAT(run_as_threads(count, {seed, 500us}, talk_to_all), Each(IsEmpty())) << count << ", seed " << seed;
  }
}

// One after the other, the first message of two senders overtakes that of the other with some seeds.
TEST(ThreadRanks, DelaysChangeTheOrderBetweenPairs) {
  std::array<unsigned, 3> first{};
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    std::atomic<unsigned> sent = 0;
    run_as_threads(3, {seed, 20'000us}, [&](Transport& transport) {
      if (transport.ranks().own != 0) {
        transport.send(0, 1, {});
        ++sent;
      } else {
        while (sent < 2) std::this_thread::yield();
        ++first[next_message(transport).from];
      }
    });
  }
  EXPECT_GT(first[1], 0U);
  EXPECT_GT(first[2], 0U);
}

TEST(ThreadRanks, WaitingEndsWithAMessageOrWithItsLimit) {
  const auto ends = run_as_threads(2, {}, [](Transport& transport) {
    if (transport.ranks().own == 0) {
      EXPECT_FALSE(transport.wait(1ms)) << "nobody has sent anything";
      transport.send(1, 1, {});
      EXPECT_TRUE(transport.wait(std::chrono::hours(1)));
      EXPECT_TRUE(transport.wait(std::chrono::hours(1))) << "it is still there";
      EXPECT_TRUE(transport.poll());
    } else {
      EXPECT_TRUE(transport.wait(std::chrono::hours(1)));
      transport.send(0, 1, {});
    }
    transport.close({}, 0);
  });
  EXPECT_THAT(ends, Each(IsEmpty()));
}

TEST(ThreadRanks, OneEndsAllAndIsNamed) {
  const auto ends = run_as_threads(3, {}, [](Transport& transport) {
    if (transport.ranks().own == 1) transport.abort("the disk is full");
    if (transport.ranks().own == 2) transport.close({}, 0);
    for (;;) transport.wait(std::chrono::hours(1));
  });
  EXPECT_THAT(ends, Each(HasSubstr("rank 1: the disk is full")));
}

TEST(ThreadRanks, ClosingWaitsForAllButTheLost) {
  std::atomic<unsigned> about_to_close = 0;
  const auto ends = run_as_threads(4, {}, [&](Transport& transport) {
    ++about_to_close;
    transport.close({}, 0);
    EXPECT_EQ(about_to_close, 4U);
  });
  EXPECT_THAT(ends, Each(IsEmpty()));
  const std::vector<unsigned> lost = {2};
  run_as_threads(3, {}, [&](Transport& transport) {
    if (transport.ranks().own != 2) transport.close(lost, 0);
  });
}

}  // namespace
}  // namespace torolux::ranks
