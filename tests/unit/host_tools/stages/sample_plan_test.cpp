// SPDX-License-Identifier: MIT
// Which pixels get more samples: all the least, in two passes; blocks whose halves look different, and their
// neighbours, twice as many, until nothing differs or they have the most; a block's tiles cover it once.
#include "host_tools/stages/sample_plan.hpp"

#include <gtest/gtest.h>

#include <map>

namespace torolux::test {
namespace {

constexpr std::uint32_t kWidth = 15, kHeight = 9;  // of blocks at the edge only a part is in the picture

RayTracingSettings settings_of(std::uint32_t least, std::uint32_t most, double noise) {
  RayTracingSettings settings;
  settings.width = kWidth;
  settings.height = kHeight;
  settings.samples = most;
  settings.least_samples = least;
  settings.noise = noise;
  return settings;
}

/// How many tiles have a pixel.
std::vector<int> covered(const SamplePlan& plan, unsigned pes) {
  std::vector<int> counts(std::size_t{kWidth} * kHeight);
  for (const protocol::Tile& tile : plan.tiles(pes)) {
    for (std::uint32_t row = tile.row; row < std::uint32_t{tile.row} + tile.rows; ++row) {
      for (std::uint32_t column = tile.column; column < std::uint32_t{tile.column} + tile.columns; ++column)
        ++counts.at(std::size_t{row} * kWidth + column);
    }
  }
  return counts;
}

/// Ends a pass after which each pixel of it has the sum that `value` of a sample makes.
template <class Value>
void end_pass(SamplePlan& plan, std::vector<PixelSums>& sums, Value value) {
  const std::vector<int> in_pass = covered(plan, 1);
  for (std::uint32_t pixel = 0; pixel < sums.size(); ++pixel) {
    if (in_pass[pixel] == 0) continue;
    for (std::uint32_t i = 0; i < plan.pass().count; ++i) {
      for (std::int64_t& channel : sums[pixel]) channel += value(pixel, plan.pass().first + i);
    }
    plan.take(pixel, std::span(sums).subspan(pixel, 1));
  }
  plan.advance();
}

TEST(SamplePlan, GivesAllTheLeastInTwoPassesWhereNothingDiffers) {
  SamplePlan plan(settings_of(8, 64, 1));
  std::vector<PixelSums> sums(std::size_t{kWidth} * kHeight);
  for (const std::uint32_t first : {0U, 4U}) {
    ASSERT_FALSE(plan.finished());
    EXPECT_EQ(plan.pass().first, first);
    EXPECT_EQ(plan.pass().count, 4U);
    for (const unsigned pes : {1U, 16U}) EXPECT_EQ(covered(plan, pes), std::vector<int>(sums.size(), 1)) << pes;
    end_pass(plan, sums, [](std::uint32_t pixel, std::uint32_t) { return 1000 + 10 * std::int64_t{pixel}; });
  }
  EXPECT_TRUE(plan.finished());
}

/// One pixel is bright in its first sample alone: its block and the eight around have more, until that shows no more.
TEST(SamplePlan, DoublesTheSamplesOfABlockAndItsNeighbours) {
  SamplePlan plan(settings_of(4, 16, 1));
  std::vector<PixelSums> sums(std::size_t{kWidth} * kHeight);
  constexpr std::uint32_t kBright = 4 * kWidth + 6;  // in block (3, 2)
  const auto value = [](std::uint32_t pixel, std::uint32_t sample) {
    return std::int64_t{pixel == kBright && sample == 0 ? 9000 : 1000};
  };
  end_pass(plan, sums, value);
  end_pass(plan, sums, value);
  ASSERT_FALSE(plan.finished());
  EXPECT_EQ(plan.pass().first, 4U);
  EXPECT_EQ(plan.pass().count, 4U);
  const std::vector<int> chosen = covered(plan, 4);
  for (std::uint32_t pixel = 0; pixel < chosen.size(); ++pixel) {
    const std::uint32_t column = pixel % kWidth / 2, row = pixel / kWidth / 2;
    EXPECT_EQ(chosen[pixel], column >= 2 && column <= 4 && row >= 1 && row <= 3 ? 1 : 0) << pixel;
  }
  end_pass(plan, sums, value);
  ASSERT_FALSE(plan.finished());
  EXPECT_EQ(plan.pass().first, 8U);
  EXPECT_EQ(plan.pass().count, 8U);
  EXPECT_EQ(covered(plan, 4), chosen);
  end_pass(plan, sums, value);
  EXPECT_TRUE(plan.finished()) << "the most";
}

TEST(SamplePlan, TakesNoMoreThanTheMost) {
  SamplePlan plan(settings_of(5, 12, 0));
  std::vector<PixelSums> sums(std::size_t{kWidth} * kHeight);
  const auto value = [](std::uint32_t, std::uint32_t sample) { return std::int64_t{1000} + sample; };
  std::map<std::uint32_t, std::uint32_t> passes;
  while (!plan.finished()) {
    passes[plan.pass().first] = plan.pass().count;
    end_pass(plan, sums, value);
  }
  EXPECT_EQ(passes, (std::map<std::uint32_t, std::uint32_t>{{0, 2}, {2, 3}, {5, 5}, {10, 2}}));
}

/// Black parts, and a picture all black, ask for nothing.
TEST(SamplePlan, EndsWhereAllIsBlack) {
  SamplePlan plan(settings_of(2, 8, 0));
  std::vector<PixelSums> sums(std::size_t{kWidth} * kHeight);
  end_pass(plan, sums, [](std::uint32_t, std::uint32_t) { return std::int64_t{0}; });
  end_pass(plan, sums, [](std::uint32_t, std::uint32_t) { return std::int64_t{0}; });
  EXPECT_TRUE(plan.finished());
}

}  // namespace
}  // namespace torolux::test
