// SPDX-License-Identifier: MIT
// Proves: two memories are compared whole, whichever side has touched a page, and the first difference is the lowest.
#include "emulator/engines/lockstep/memory_pair.hpp"

#include <gtest/gtest.h>

namespace torolux::lockstep {
namespace {

constexpr std::uint32_t kPage = 4096;
constexpr std::uint32_t kBytes = 64 * kPage + 100;

class MemoryPairTest : public testing::Test {
 protected:
  std::uint64_t touched_bytes() {
    std::uint64_t bytes = 0;
    for (const MemoryRange& range : pair_.touched()) bytes += range.end - range.begin;
    return bytes;
  }

  SharedMemory first_{"first", 2 * kBytes}, second_{"second", kBytes};
  MemoryPair pair_{first_, second_, kBytes};
};

TEST_F(MemoryPairTest, UntouchedMemoryIsEqual) {
  EXPECT_EQ(pair_.first_difference(), std::nullopt);
  EXPECT_EQ(touched_bytes(), 0U);
}

TEST_F(MemoryPairTest, EveryByteCounts) {
  for (const std::uint32_t offset : {0U, 1U, kPage - 1, kPage, 40 * kPage + 17, 64 * kPage + 99}) {
    for (const SharedMemory* side : {&first_, &second_}) {
      side->bytes()[offset] = std::byte{1};
      EXPECT_EQ(pair_.first_difference(), offset);
      side->bytes()[offset] = std::byte{0};
      EXPECT_EQ(pair_.first_difference(), std::nullopt);
    }
  }
}

TEST_F(MemoryPairTest, TheLowestDifferenceIsFirst) {
  first_.bytes()[50 * kPage + 7] = std::byte{1};
  second_.bytes()[12 * kPage + 5] = std::byte{1};
  second_.bytes()[12 * kPage + 9] = std::byte{1};
  EXPECT_EQ(pair_.first_difference(), 12 * kPage + 5);
}

TEST_F(MemoryPairTest, WhatLiesBehindIsNotLookedAt) {
  first_.bytes()[kBytes] = std::byte{1};
  first_.bytes()[kBytes + kPage] = std::byte{1};
  EXPECT_EQ(pair_.first_difference(), std::nullopt);
}

TEST_F(MemoryPairTest, OnlyTouchedPagesAreRead) {
  first_.bytes()[3 * kPage] = std::byte{1};
  second_.bytes()[3 * kPage] = std::byte{1};
  second_.bytes()[4 * kPage] = std::byte{0};
  first_.bytes()[64 * kPage] = std::byte{0};
  EXPECT_EQ(touched_bytes(), 2 * kPage + 100);
  EXPECT_EQ(pair_.first_difference(), std::nullopt);
}

}  // namespace
}  // namespace torolux::lockstep
