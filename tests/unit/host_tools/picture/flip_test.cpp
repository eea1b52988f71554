// SPDX-License-Identifier: MIT
// Proves: FLIP has the values that the authors' own program (version 1.7) has for the same pictures, of all parts of
// the measure, at several distances, of display values and of radiance; and it is 0 for equal pictures, at most 1, and
// the same both ways.
#include "host_tools/picture/flip.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "firmware/protocol/random.hpp"

namespace torolux {
namespace {

using Colour = std::array<float, 3>;

/// The authors' program works with floats and with a matrix that is inverted to ten digits.
constexpr double kRounding = 5e-5;

Picture even(std::uint32_t width, std::uint32_t height, const Colour& colour) {
  return {width, height, std::vector<Colour>(std::size_t{width} * height, colour)};
}

/// Dark on the left, light from column `at` on.
Picture edge(std::uint32_t at) {
  Picture picture = even(48, 32, {0.1F, 0.1F, 0.1F});
  for (std::uint32_t i = 0; i < 48 * 32; ++i) {
    if (i % 48 >= at) picture.pixels[i] = {0.8F, 0.7F, 0.5F};
  }
  return picture;
}

/// Three ramps; amplitude: of independent noise in each channel.
Picture ramps(float amplitude) {
  Picture picture = even(40, 30, {});
  for (std::uint32_t i = 0; i < 40 * 30; ++i) {
    const std::uint32_t row = i / 40;
    const auto x = static_cast<float>(i % 40);
    const auto y = static_cast<float>(row);
    picture.pixels[i] = {x / 40, y / 30, (x + y) / 70};
    for (std::uint32_t c = 0; c < 3; ++c) {
      const float noise = amplitude * (protocol::uniform_float(protocol::hash_combine(i, c)) - 0.5F);
      picture.pixels[i][c] = std::clamp(picture.pixels[i][c] + noise, 0.0F, 1.0F);
    }
  }
  return picture;
}

Picture fourth_power(Picture picture, float factor) {
  for (auto& pixel : picture.pixels) {
    for (float& channel : pixel) channel = factor * channel * channel * channel * channel;
  }
  return picture;
}

double mean(const Picture& a, const Picture& b, double pixels_per_degree) {
  return pool(flip(a, b, pixels_per_degree)).mean;
}

TEST(Flip, IsNothingForEqualPictures) {
  EXPECT_EQ(pool(flip(ramps(0.2F), ramps(0.2F), 67)).worst, 0);
  EXPECT_EQ(pool(hdr_flip(ramps(0.2F), ramps(0.2F), 67)).worst, 0);
}

TEST(Flip, OfEvenColoursIsTheirDistance) {
  EXPECT_NEAR(mean(even(16, 12, {0, 0, 0}), even(16, 12, {1, 1, 1}), 67), 0.967392, kRounding);
  EXPECT_NEAR(mean(even(16, 12, {0.2F, 0.2F, 0.2F}), even(16, 12, {0.25F, 0.25F, 0.25F}), 67), 0.183433, kRounding);
  // No two colours are further apart.
  EXPECT_NEAR(mean(even(16, 12, {0, 1, 0}), even(16, 12, {0, 0, 1}), 67), 1, kRounding);
}

TEST(Flip, OfAnEdgeThatMovesByAPixel) {
  EXPECT_NEAR(mean(edge(25), edge(24), 67), 0.063424, kRounding);
  EXPECT_NEAR(mean(edge(25), edge(24), 30), 0.049900, kRounding);
  const Plane map = flip(edge(25), edge(24), 67);
  EXPECT_EQ(map.values[16 * 48], 0) << "far away from it nothing has changed";
  EXPECT_NEAR(pool(map).worst_x, 24, 1);
}

TEST(Flip, OfNoiseGrowsAsTheEyeComesNearer) {
  EXPECT_NEAR(mean(ramps(0.2F), ramps(0), 67), 0.115612, kRounding);
  EXPECT_NEAR(mean(ramps(0.2F), ramps(0), 20), 0.273490, kRounding);
}

TEST(Flip, IsTheSameBothWays) {
  EXPECT_EQ(flip(ramps(0.2F), ramps(0), 67).values, flip(ramps(0), ramps(0.2F), 67).values);
}

TEST(Flip, OfRadianceIsTheWorstOfItsExposures) {
  const Picture bright = fourth_power(ramps(0), 50);
  const Picture noisy = fourth_power(ramps(0.2F), 50);
  EXPECT_NEAR(pool(hdr_flip(noisy, bright, 67)).mean, 0.203827, kRounding);
  EXPECT_NEAR(pool(hdr_flip(noisy, bright, 30)).mean, 0.319919, kRounding);
  // Exposures come from the reference, so units do not matter.
  EXPECT_NEAR(pool(hdr_flip(fourth_power(ramps(0.2F), 0.5F), fourth_power(ramps(0), 0.5F), 67)).mean, 0.203827,
              kRounding);
}

TEST(Flip, OfRadianceThatIsDarkHasExposures) {
  EXPECT_EQ(pool(hdr_flip(even(4, 3, {}), even(4, 3, {}), 67)).worst, 0);
  EXPECT_GT(pool(hdr_flip(even(4, 3, {1, 1, 1}), even(4, 3, {}), 67)).mean, 0.5);
  Picture lamp = even(8, 8, {});
  lamp.pixels[27] = {100, 100, 100};
  EXPECT_GT(pool(hdr_flip(even(8, 8, {}), lamp, 67)).worst, 0.5);
  EXPECT_LE(pool(hdr_flip(even(8, 8, {}), lamp, 67)).worst, 1);
}

TEST(Pool, MeanPercentileAndWorst) {
  Plane plane(10, 10);
  for (std::uint32_t i = 0; i < 100; ++i) plane.values[i] = static_cast<float>((i * 37) % 100);
  const Pooled pooled = pool(plane);
  EXPECT_DOUBLE_EQ(pooled.mean, 49.5);
  EXPECT_EQ(pooled.percentile_95, 94);
  EXPECT_EQ(pooled.worst, 99);
  EXPECT_EQ((pooled.worst_y * 10 + pooled.worst_x) * 37 % 100, 99U);
}

}  // namespace
}  // namespace torolux
