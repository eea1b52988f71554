// SPDX-License-Identifier: MIT
// Proves: of an error of stripes nearly all is directed, whatever their angle and width; of grain, round patches and a
// single patch nearly nothing, however strong; a mixture has the stripes' part of it.
#include "host_tools/picture/streaks.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware/protocol/random.hpp"

namespace torolux {
namespace {

constexpr std::uint32_t kEdge = 192;

float noise_at(std::uint32_t key, std::uint32_t seed) {
  return protocol::uniform_float(protocol::hash_combine(seed, key)) - 0.5F;
}

/// Independent in each pixel, then blurred to grains of about 2 sigma pixels; standard deviation 1.
Plane grain(double sigma, std::uint32_t seed) {
  Plane plane(kEdge, kEdge);
  for (std::uint32_t i = 0; i < kEdge * kEdge; ++i) plane.values[i] = noise_at(i, seed);
  if (sigma > 0) {
    const auto weights = gaussian_weights(sigma, static_cast<int>(3 * sigma) + 1);
    plane = filter(plane, weights, weights);
  }
  double square = 0;
  for (const float value : plane.values) square += double{value} * double{value} / (kEdge * kEdge);
  for (float& value : plane.values) value /= static_cast<float>(std::sqrt(square));
  return plane;
}

/// Random stripes, `width` pixels wide, at this angle; standard deviation about 1.
Plane stripes(double width, double degrees, std::uint32_t seed) {
  Plane plane(kEdge, kEdge);
  const double angle = degrees * std::numbers::pi / 180;
  for (std::uint32_t i = 0; i < kEdge * kEdge; ++i) {
    const std::uint32_t column = i % kEdge;
    const std::uint32_t row = i / kEdge;
    const double across = (column * std::cos(angle) + row * std::sin(angle)) / width + 1000;
    const double part = across - std::floor(across);
    const auto stripe = static_cast<std::uint32_t>(across);
    const double blend = part * part * (3 - 2 * part);
    plane.values[i] = static_cast<float>(
        3.9 * (double{noise_at(stripe, seed)} * (1 - blend) + double{noise_at(stripe + 1, seed)} * blend));
  }
  return plane;
}

Plane sum(const Plane& a, const Plane& b, float factor) {
  Plane result = a;
  for (std::size_t i = 0; i < a.values.size(); ++i) result.values[i] += factor * b.values[i];
  return result;
}

TEST(Streaks, StripesAreDirectedAtAnyAngle) {
  for (const double degrees : {0.0, 17.0, 45.0, 71.0, 90.0, 130.0}) {
    EXPECT_GT(streaks(stripes(4, degrees, 1)).share, 0.85) << degrees << " degrees";
  }
}

TEST(Streaks, StripesAreDirectedWhateverTheirWidth) {
  for (const double width : {1.5, 3.0, 6.0, 12.0}) {
    EXPECT_GT(streaks(stripes(width, 30, 2)).share, 0.85) << width << " pixels";
  }
}

TEST(Streaks, GrainAndPatchesAreNot) {
  for (const double sigma : {0.0, 1.0, 2.0, 4.0}) {
    EXPECT_LT(streaks(grain(sigma, 3)).share, 0.06) << "grains of " << 2 * sigma << " pixels";
  }
}

// The constant that is taken off is that of white noise: without it more than one percent would be left.
TEST(Streaks, EqualNoiseHasNextToNothingLeft) {
  double share = 0;
  for (std::uint32_t seed = 0; seed < 4; ++seed) share += streaks(grain(0, 10 + seed)).share / 4;
  EXPECT_NEAR(share, 0, 0.004);
}

TEST(Streaks, ASinglePatchIsNot) {
  Plane plane(kEdge, kEdge);
  for (std::uint32_t i = 0; i < kEdge * kEdge; ++i) {
    const std::uint32_t row = i / kEdge;
    const double distance = std::hypot(i % kEdge - 90.0, row - 100.0);
    plane.values[i] = static_cast<float>(std::exp(-distance * distance / 50));
  }
  EXPECT_LT(streaks(plane).share, 0.25);
}

TEST(Streaks, AMixtureHasTheStripesPart) {
  const Streaks alone = streaks(stripes(6, 20, 5));
  const Streaks both = streaks(sum(stripes(6, 20, 5), grain(0, 6), 0.5F));
  EXPECT_NEAR(both.directed, alone.directed, 0.2 * alone.directed);
  EXPECT_LT(both.share, alone.share);
  // Twice the error is twice the streaks, and the same share of it.
  const Streaks twice = streaks(sum(stripes(6, 20, 5), stripes(6, 20, 5), 1));
  EXPECT_NEAR(twice.directed, 2 * alone.directed, 1e-5);
  EXPECT_NEAR(twice.share, alone.share, 1e-6);
}

TEST(Streaks, OfPicturesAreInUnitsOfLightness) {
  // Grey of 0.18 has L* 49.5, of 0.20 has 51.8: stripes of these on the even one.
  Picture reference{kEdge, kEdge, std::vector<std::array<float, 3>>(kEdge * kEdge, {0.18F, 0.18F, 0.18F})};
  Picture striped = reference;
  for (std::uint32_t i = 0; i < kEdge * kEdge; ++i) {
    if (i % kEdge / 4 % 2 == 0) striped.pixels[i] = {0.20F, 0.20F, 0.20F};
  }
  const Streaks found = streaks(striped, reference);
  EXPECT_GT(found.directed, 0.4);
  EXPECT_LT(found.directed, 1.2) << "half of 2.3 is the RMS of what is left without the mean";
  EXPECT_GT(found.share, 0.95);
}

TEST(Streaks, NoneBetweenEqualAndTinyPictures) {
  const Picture tiny{1, 2, {{0.5F, 0.5F, 0.5F}, {0.2F, 0.2F, 0.2F}}};
  EXPECT_EQ(streaks(tiny, tiny).directed, 0);
  EXPECT_EQ(streaks(tiny, tiny).share, 0);
}

}  // namespace
}  // namespace torolux
