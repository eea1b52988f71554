// SPDX-License-Identifier: MIT
// The measure of pictures, on pictures whose errors are known, and against `torolux compare`'s own.
#include "tests/references/picture_error.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "host_tools/picture/compare.hpp"
#include "tests/references/random.hpp"

namespace torolux::references {
namespace {

/// value(x, y) in all channels.
template <class Value>
Picture picture(std::uint32_t width, std::uint32_t height, Value value) {
  Picture result{width, height, {}};
  for (std::uint32_t y = 0; y < height; ++y) {
    for (std::uint32_t x = 0; x < width; ++x) {
      const auto v = static_cast<float>(value(x, y));
      result.pixels.push_back({v, v, v});
    }
  }
  return result;
}

TEST(PictureError, OfAPictureThatIsTooBright) {
  const Picture grey = picture(16, 8, [](auto x, auto) { return x < 8 ? 1 : 2; });
  const Picture brighter = picture(16, 8, [](auto x, auto) { return x < 8 ? 1.1 : 1.9; });
  const PictureError error = picture_error(brighter, grey);
  EXPECT_NEAR(error.mean, 0, 1e-6);
  EXPECT_NEAR(error.rmse, 0.1 / std::sqrt(2.5), 1e-6);
  EXPECT_EQ(picture_error(grey, grey).rmse, 0);
}

/// What cancels within blocks of 4 x 4 is no error; what does not, is.
TEST(PictureError, IsOfBlocksOfFourByFour) {
  const Picture flat = picture(16, 16, [](auto, auto) { return 1; });
  const Picture fine = picture(16, 16, [](auto x, auto y) { return (x + y) % 2 == 0 ? 0.5 : 1.5; });
  const Picture coarse = picture(16, 16, [](auto x, auto y) { return (x / 4 + y / 4) % 2 == 0 ? 0.5 : 1; });
  EXPECT_NEAR(picture_error(fine, flat).rmse, 0.25, 1e-6);  // cut off at 1, so 0.75 in each block
  const Picture dim = picture(16, 16, [](auto x, auto y) { return (x + y) % 2 == 0 ? 0.1 : 0.3; });
  EXPECT_NEAR(picture_error(dim, flat).rmse, 0.8, 1e-6);
  EXPECT_NEAR(picture_error(coarse, flat).rmse, std::sqrt(0.125), 1e-6);
}

/// 2 % of the pixels are lamps: they count no more than the brightest of the rest.
TEST(PictureError, DoesNotLetLampsHideTheRest) {
  const auto lamp = [](auto x, auto y) { return y == 0 && x < 8; };
  const Picture reference = picture(20, 20, [&](auto x, auto y) { return lamp(x, y) ? 1000.0 : 1.0; });
  const Picture result = picture(20, 20, [&](auto x, auto y) { return lamp(x, y) ? 500.0 : 0.9; });
  const PictureError error = picture_error(result, reference);
  EXPECT_EQ(error.clamp, 1);
  EXPECT_NEAR(error.mean, -0.098, 1e-6);
  EXPECT_LT(error.plain_mean, -0.4);
  EXPECT_NEAR(error.rmse, 0.098, 0.0015);  // the blocks with the lamps are a little nearer
}

TEST(PictureError, IsThatOfTheProductsOwnCompare) {
  Random random(5, 5);
  const Picture a = picture(37, 22, [&](auto, auto) { return std::exp(6 * random.uniform()); });
  const Picture b = picture(37, 22, [&](auto, auto) { return std::exp(6 * random.uniform()); });
  const Comparison comparison = compare(a, b);
  const PictureError error = picture_error(a, b);
  EXPECT_NEAR(error.clamp, comparison.clamp, 1e-9 * comparison.clamp);
  EXPECT_NEAR(error.rmse, comparison.block_rmse, 1e-9);
}

}  // namespace
}  // namespace torolux::references
