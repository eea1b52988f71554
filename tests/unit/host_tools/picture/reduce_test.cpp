// SPDX-License-Identifier: MIT
// Proves: a picture that is small enough stays as tone_map shows it; blocks become the means of what is shown.
#include "host_tools/picture/reduce.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "host_tools/picture/tone_map.hpp"

namespace torolux {
namespace {

/// Rising from left to right, with a lamp at the lower right.
Picture slope(std::uint32_t width, std::uint32_t height) {
  Picture picture{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const float value = 0.1F + static_cast<float>(i % width);
    picture.pixels.push_back({value, value / 2, value / 4});
  }
  picture.pixels.back() = {1000, 1000, 1000};
  return picture;
}

TEST(Reduce, LeavesSmallPicturesAsTheyAreShown) {
  const Picture picture = slope(7, 5);
  const ReducedPicture same = reduce(picture, {1, ToneCurve::filmic}, 7);
  EXPECT_EQ(same.width, 7U);
  EXPECT_EQ(same.height, 5U);
  EXPECT_EQ(same.bytes, tone_map(picture, {1, ToneCurve::filmic}));
}

TEST(Reduce, MakesBlocksOfAtMostTheWantedEdge) {
  const ReducedPicture small = reduce(slope(7, 5), {}, 3);  // blocks of 3 x 3, those at the edges smaller
  EXPECT_EQ(small.width, 3U);
  EXPECT_EQ(small.height, 2U);
  EXPECT_EQ(small.bytes.size(), 3U * 3 * 2);
}

TEST(Reduce, TakesMeansOfWhatIsShown) {
  // With the linear curve 1 and 0 are shown as they are at this exposure; half of what is shown is 0.5.
  Picture picture{2, 2, {{1, 0, 1}, {0, 0, 1}, {1, 0, 1}, {0, 0, 1}}};
  const double exposure = -std::log2(exposure_factor(picture, 0));
  const ReducedPicture small = reduce(picture, {exposure, ToneCurve::linear}, 1);
  EXPECT_EQ(small.bytes, (std::vector<std::uint8_t>{to_srgb(0.5F), 0, 255}));
  // A lamp far above white counts as white, not as a thousand of it.
  picture.pixels[0] = {1000, 0, 1000};
  const double again = -std::log2(exposure_factor(picture, 0));
  EXPECT_EQ(reduce(picture, {again, ToneCurve::linear}, 1).bytes, small.bytes);
}

}  // namespace
}  // namespace torolux
