// SPDX-License-Identifier: MIT
// Proves: compare finds means, relative errors and the worst pixel of pictures whose difference is known by hand.
#include "host_tools/picture/compare.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "emulator/errors.hpp"
#include "tests/unit/host_tools/picture/sample_picture.hpp"

namespace torolux {
namespace {

using Colour = std::array<float, 3>;
using testing::HasSubstr;
using testing_support::message_of;

Picture even(std::uint32_t width, std::uint32_t height, const Colour& colour) {
  return {width, height, std::vector<Colour>(std::size_t{width} * height, colour)};
}

TEST(Compare, FindsNothingBetweenEqualPictures) {
  const Picture picture = testing_support::sample_picture(9, 7);
  const Comparison result = compare(picture, picture);
  EXPECT_EQ(result.relative_rmse, 0);
  EXPECT_EQ(result.block_rmse, 0);
  EXPECT_EQ(result.worst, 0);
  EXPECT_EQ(result.differing, 0U);
}

TEST(Compare, RelativeErrorAndMeansOfEvenPictures) {
  const Comparison result = compare(even(8, 8, {1.5F, 0, 0}), even(8, 8, {1, 0, 0}));
  EXPECT_DOUBLE_EQ(result.mean[0], 1.5);
  EXPECT_DOUBLE_EQ(result.reference_mean[0], 1.0);
  EXPECT_DOUBLE_EQ(result.relative_rmse, 0.5);
  EXPECT_EQ(result.differing, 64U);
}

TEST(Compare, FindsTheWorstPixel) {
  Picture picture = even(5, 6, {1, 1, 1});
  picture.pixels[3 * 5 + 2] = {1, 3, 1};
  picture.pixels[0] = {2, 1, 1};
  const Comparison result = compare(picture, even(5, 6, {1, 1, 1}));
  EXPECT_DOUBLE_EQ(result.worst, 2);
  EXPECT_EQ(result.worst_x, 2U);
  EXPECT_EQ(result.worst_y, 3U);
  EXPECT_EQ(result.worst_channel, 1U);
  EXPECT_EQ(result.differing, 2U);
}

// Noise of +-1/2 in a checkerboard is 50 % by pixel and nothing by 4 x 4 block.
TEST(Compare, BlocksAverageNoiseAway) {
  Picture picture = even(10, 6, {});
  for (std::uint32_t i = 0; i < 60; ++i) {
    const float value = (i % 10 + i / 10) % 2 == 0 ? 1.5F : 0.5F;
    picture.pixels[i] = {value, value, value};
  }
  // The clamp (1) would cut the upper half of the noise off; a brighter stripe of the reference lifts it.
  Picture reference = even(10, 6, {1, 1, 1});
  for (std::uint32_t i = 56; i < 60; ++i) picture.pixels[i] = reference.pixels[i] = {9, 9, 9};
  const Comparison result = compare(picture, reference);
  EXPECT_DOUBLE_EQ(result.clamp, 9);
  EXPECT_NEAR(result.relative_rmse, std::sqrt(56 * 0.25 / (56 + 4 * 81)), 1e-12);
  EXPECT_NEAR(result.block_rmse, 0, 1e-12);
}

TEST(Compare, ClampHidesTheLamp) {
  Picture picture = even(20, 20, {1, 1, 1});
  Picture reference = picture;
  for (std::size_t i = 0; i < 8; ++i) picture.pixels[i] = {100, 100, 100};  // 2 % of all
  for (std::size_t i = 0; i < 8; ++i) reference.pixels[i] = {50, 50, 50};
  const Comparison result = compare(picture, reference);
  EXPECT_DOUBLE_EQ(result.clamp, 1);
  EXPECT_EQ(result.block_rmse, 0);
  EXPECT_GT(result.relative_rmse, 0.9);
}

TEST(Compare, RefusesWhatCannotBeCompared) {
  EXPECT_THAT(message_of<InputError>([] { compare(even(2, 3, {}), even(3, 2, {})); }), HasSubstr("2 x 3"));
  Picture bad = even(3, 3, {1, 1, 1});
  bad.pixels[5][1] = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THAT(message_of<InputError>([&] { compare(bad, even(3, 3, {})); }), HasSubstr("(2, 1)"));
  EXPECT_THROW(compare(even(3, 3, {}), bad), InputError);
}

TEST(Compare, BlackReference) {
  EXPECT_EQ(compare(even(2, 2, {}), even(2, 2, {})).relative_rmse, 0);
  EXPECT_TRUE(std::isinf(compare(even(2, 2, {1, 1, 1}), even(2, 2, {})).relative_rmse));
}

TEST(Difference, IsAbsolute) {
  const Picture result = difference(even(1, 1, {1, 2, 3}), even(1, 1, {3, 2, 1}));
  EXPECT_EQ(result.pixels[0], (Colour{2, 0, 2}));
}

}  // namespace
}  // namespace torolux
