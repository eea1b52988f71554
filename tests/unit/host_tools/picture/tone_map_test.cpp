// SPDX-License-Identifier: MIT
// Proves: the tone curve is monotone, keeps hue, never clips, leaves middle grey alone, has a toe and a shoulder;
// exposure is automatic, unmoved by a lamp in view, and one EV is a factor of two.
#include "host_tools/picture/tone_map.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "firmware/protocol/random.hpp"

namespace torolux {
namespace {

using Colour = std::array<float, 3>;

Colour times(const Colour& colour, float factor) {
  return {colour[0] * factor, colour[1] * factor, colour[2] * factor};
}

/// Where the middle channel lies between the least and the greatest, 0..1, and which channel is which: the hue.
double hue(const Colour& c, std::array<int, 3>& order) {
  order = {0, 1, 2};
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return c[static_cast<std::size_t>(a)] < c[static_cast<std::size_t>(b)]; });
  const auto at = [&](std::size_t rank) { return double{c[static_cast<std::size_t>(order[rank])]}; };
  return (at(1) - at(0)) / (at(2) - at(0));
}

Colour random_colour(std::uint32_t i) {
  Colour colour{};
  for (std::uint32_t c = 0; c < 3; ++c)
    colour[c] = std::exp2(12 * protocol::uniform_float(protocol::hash_combine(i, c)) - 6);
  return colour;
}

TEST(ToneCurve, KeepsHue) {
  for (std::uint32_t i = 0; i < 10000; ++i) {
    const Colour in = random_colour(i);
    std::array<int, 3> order_in{};
    std::array<int, 3> order_out{};
    const double hue_in = hue(in, order_in);
    const Colour out = compress(in, ToneCurve::filmic);
    if (std::max({out[0], out[1], out[2]}) - std::min({out[0], out[1], out[2]}) < 1e-2F) continue;  // no hue to see
    EXPECT_NEAR(hue(out, order_out), hue_in, 1e-4) << "rounding of floats over a spread of at least 0.01";
    EXPECT_EQ(order_out, order_in);
  }
}

TEST(ToneCurve, IsMonotoneInEveryChannelAndStaysWithinOne) {
  for (std::uint32_t i = 0; i < 200; ++i) {
    const Colour colour = random_colour(i);
    Colour before{0, 0, 0};
    for (float exposure = 0.001F; exposure < 1000; exposure *= 1.1F) {
      const Colour now = compress(times(colour, exposure), ToneCurve::filmic);
      for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_GE(now[c], before[c] - 1e-6F) << "rounding";
        EXPECT_LE(now[c], 1.0F);
      }
      before = now;
    }
  }
}

double grey(double value) {
  const auto v = static_cast<float>(value);
  return double{compress({v, v, v}, ToneCurve::filmic)[0]};
}

/// Slope over doublings: 1 where the curve keeps contrast.
double contrast(double value) {
  return std::log2(grey(value * 1.01) / grey(value / 1.01)) / std::log2(1.01 * 1.01);
}

TEST(ToneCurve, HasAToeAndAShoulderAndLeavesMiddleGrey) {
  EXPECT_NEAR(grey(kMiddleGrey), kMiddleGrey, 1e-6);
  EXPECT_NEAR(grey(kWhite), 1, 1e-6);
  EXPECT_LT(grey(kWhite * 0.9), 1) << "not before";
  EXPECT_GT(grey(kWhite / 2), 0.9);
  for (const double dark : {0.001, 0.01, 0.1}) EXPECT_LT(grey(dark), dark);
  EXPECT_NEAR(contrast(1e-4), 1.3, 1e-2) << "the toe's: below middle grey contrast grows";
  EXPECT_GT(contrast(kMiddleGrey), 1) << "about the middle nothing is flattened";
  EXPECT_LT(contrast(2), 0.5) << "the shoulder bends";
  for (int step = 0; step < 34; ++step) {
    const double x = 1e-3 * std::pow(1.3, step);
    EXPECT_GT(contrast(x), contrast(x * 1.3)) << "one bend, no waves, at " << x;
  }
}

TEST(ToneCurve, LinearOnlyCutsOff) {
  EXPECT_EQ(compress({0.25F, 1.0F, 3.0F}, ToneCurve::linear), (Colour{0.25F, 1.0F, 1.0F}));
}

TEST(ToneCurve, FarTooBrightTurnsWhite) {
  const Colour out = compress({1e4F, 1e3F, 1e2F}, ToneCurve::filmic);
  for (const float channel : out) EXPECT_GT(channel, 0.99F);
}

TEST(ToneCurve, WhatIsNoNumberCountsAsZero) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  for (const ToneCurve curve : {ToneCurve::filmic, ToneCurve::linear}) {
    EXPECT_EQ(compress({nan, inf, -1.0F}, curve), (Colour{0, 0, 0}));
  }
}

TEST(Srgb, MatchesTheStandard) {
  EXPECT_EQ(to_srgb(0.0F), 0);
  EXPECT_EQ(to_srgb(1.0F), 255);
  EXPECT_EQ(to_srgb(2.0F), 255);
  EXPECT_EQ(to_srgb(0.18F), 118);  // IEC 61966-2-1: 0.4614 * 255
  EXPECT_EQ(to_srgb(0.5F), 188);
  EXPECT_EQ(to_srgb(0.002F), 7);  // linear part: 12.92 * 0.002 * 255 = 6.59
}

TEST(Exposure, BringsAnEvenPictureToMiddleGrey) {
  Picture picture{10, 10, std::vector<Colour>(100, Colour{3, 3, 3})};
  EXPECT_NEAR(exposure_factor(picture, 0) * 3, kMiddleGrey, 1e-12);
  EXPECT_NEAR(exposure_factor(picture, 2) * 3, 4 * kMiddleGrey, 1e-12);
  EXPECT_EQ(tone_map(picture, {}), std::vector<std::uint8_t>(300, 118));
}

TEST(Exposure, IsNotMovedByALampInViewOrByBlack) {
  Picture picture{10, 10, std::vector<Colour>(100, Colour{0.1F, 0.1F, 0.1F})};
  const double before = exposure_factor(picture, 0);
  for (std::size_t i = 0; i < 9; ++i) picture.pixels[i] = {17, 12, 4};
  for (std::size_t i = 9; i < 40; ++i) picture.pixels[i] = {0, 0, 0};
  // 9 of 69 lit pixels are the lamp, one of them beyond the tenth that is left out at either end counts.
  EXPECT_NEAR(std::log2(exposure_factor(picture, 0) / before), 0, 0.4);
  for (std::size_t i = 6; i < 9; ++i) picture.pixels[i] = {0, 0, 0};
  EXPECT_NEAR(exposure_factor(picture, 0), before, 1e-6 * before);
}

TEST(Exposure, OfABlackPictureIsOne) {
  EXPECT_EQ(exposure_factor(Picture{2, 1, {{0, 0, 0}, {0, 0, 0}}}, 0), 1.0);
}

}  // namespace
}  // namespace torolux
