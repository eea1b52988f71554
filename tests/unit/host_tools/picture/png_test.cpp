// SPDX-License-Identifier: MIT
// Proves: a .png, read back by libpng, has size, order and values as tone_map made them.
#include <gtest/gtest.h>
#include <png.h>

#include "host_tools/picture/formats.hpp"
#include "host_tools/picture/tone_map.hpp"
#include "tests/unit/host_tools/picture/sample_picture.hpp"

namespace torolux {
namespace {

TEST(Png, HoldsTheToneMappedPixels) {
  const Picture picture = testing_support::sample_picture(19, 11);
  const std::vector<std::byte> bytes = encode_png(picture, {1.5, ToneCurve::filmic});
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  ASSERT_NE(png_image_begin_read_from_memory(&image, bytes.data(), bytes.size()), 0) << image.message;
  EXPECT_EQ(image.width, 19U);
  EXPECT_EQ(image.height, 11U);
  EXPECT_EQ(image.format, unsigned{PNG_FORMAT_RGB}) << "8 bits, sRGB, no alpha";
  std::vector<std::uint8_t> pixels(PNG_IMAGE_SIZE(image));
  ASSERT_NE(png_image_finish_read(&image, nullptr, pixels.data(), 0, nullptr), 0) << image.message;
  EXPECT_EQ(pixels, tone_map(picture, {1.5, ToneCurve::filmic}));
}

TEST(Png, IsTheSameEveryTime) {
  const Picture picture = testing_support::sample_picture(64, 64);
  EXPECT_EQ(encode_png(picture, {}), encode_png(picture, {}));
}

}  // namespace
}  // namespace torolux
