// SPDX-License-Identifier: MIT
// Proves: turns are those of an arc tangent; a density in a straight line is drawn as it is; directions are of unit
// length, on their side, and drawn by the very intensity that is looked up, in bands of any width.
#include "firmware/protocol/lamp.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "firmware/protocol/random.hpp"
#include "firmware/protocol/stratified.hpp"

namespace torolux::protocol {
namespace {

constexpr double kPi = std::numbers::pi;

TEST(Lamp, TurnsAreThoseOfAnArcTangent) {
  for (int i = 0; i < 3600; ++i) {
    const double angle = (i + 0.5) / 3600 * 2 * kPi;
    const float turn = turn_of(static_cast<float>(3 * std::cos(angle)), static_cast<float>(3 * std::sin(angle)));
    EXPECT_NEAR(turn, angle / (2 * kPi), 3e-6);
  }
  EXPECT_EQ(turn_of(1, 0), 0);
  EXPECT_EQ(turn_of(0, -2), 0.75F);
}

TEST(Lamp, StraightDensitiesAreDrawnAsTheyAre) {
  for (const auto& [a, b] : {std::pair{0.0F, 2.0F}, {3.0F, 1.0F}, {1.0F, 1.0F}, {5.0F, 0.0F}}) {
    for (const float u : {0.0F, 0.25F, 0.5F, 0.999F}) {
      const float at = by_slope(u, a, b);
      EXPECT_NEAR((a * at + (b - a) * at * at / 2) / ((a + b) / 2), u, 1e-5) << a << " " << b;
    }
  }
  EXPECT_EQ(by_slope(0.5F, 0, 0), 0.5F);
}

/// Narrow bands about the axis, wide ones beyond; four sectors of which one is dark.
struct UnevenLamp {
  std::vector<float> values{1, 0.99F, 0.9F, 0.5F, 0};
  std::vector<std::uint32_t> chances;
  Lamp lamp{{1, 0, 0}, {0, 0, 1}, {0, -1, 0}, {}};

  UnevenLamp() {
    const std::vector<float> intensity{8, 8, 8, 8, 6, 4, 0, 2, 1, 3, 0, 0, 1, 2, 0, 0, 0, 1, 0, 0};
    lamp.side[0] = {4, 4, 0, 5, 0};
    values.insert(values.end(), intensity.begin(), intensity.end());
    std::vector<double> cells;
    double sum = 0;
    for (std::size_t band = 0; band < 4; ++band)
      for (std::size_t s = 0; s < 4; ++s) {
        const std::size_t at = 5 + band * 4;
        const std::size_t next = (s + 1) % 4;
        sum += double{values[at + s] + values[at + next] + values[at + 4 + s] + values[at + 4 + next]} *
               double{values[band] - values[band + 1]};
        cells.push_back(sum);
      }
    for (const double cell : cells) chances.push_back(static_cast<std::uint32_t>(cell / sum * 0xFFFF'FFFFp0));
    chances.back() = 0xFFFF'FFFFU;
  }
};

/// Parts of the draws in boxes of height and turn, and the same parts of the integral of what is looked up.
TEST(Lamp, DirectionsAreDrawnByTheIntensityThatIsLookedUp) {
  const UnevenLamp of;
  constexpr std::size_t kHeights = 20, kTurns = 8;
  std::vector<double> drawn(kHeights * kTurns, 0);
  const auto box_of = [&](const Vec3f& direction) {
    const auto height = static_cast<std::size_t>(std::min(-direction[1], 0.9999F) * kHeights);
    const float turn = turn_of(dot(direction, of.lamp.x), dot(direction, of.lamp.y));
    return height * kTurns + std::min(static_cast<std::size_t>(turn * kTurns), kTurns - 1);
  };
  constexpr std::uint32_t kDraws = 1U << 16U;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const StratifiedPair pair = stratified_pair(i, 7);
    const Vec3f direction = sample_lamp(of.lamp, 0, of.values, of.chances, pair.x, uniform_float(pair.y));
    ASSERT_NEAR(dot(direction, direction), 1, 1e-5);
    ASSERT_GE(-direction[1], 0);
    drawn[box_of(direction)] += 1.0 / kDraws;
  }
  std::vector<double> wanted(kHeights * kTurns, 0);
  double all = 0;
  for (int h = 0; h < 2000; ++h)
    for (int t = 0; t < 400; ++t) {
      const double height = (h + 0.5) / 2000;
      const double turn = (t + 0.5) / 400 * 2 * kPi;
      const double out = std::sqrt(1 - height * height);
      const Vec3f direction{static_cast<float>(out * std::cos(turn)), static_cast<float>(-height),
                            static_cast<float>(out * std::sin(turn))};
      const double light = double{lamp_intensity(of.lamp, 0, of.values, direction)};
      wanted[box_of(direction)] += light;
      all += light;
    }
  for (std::size_t box = 0; box < drawn.size(); ++box) EXPECT_NEAR(drawn[box], wanted[box] / all, 4e-4) << box;
}

TEST(Lamp, ShinesOnItsLitSideAlone) {
  const UnevenLamp of;
  EXPECT_FLOAT_EQ(lamp_intensity(of.lamp, 0, of.values, {0, -1, 0}), 8);
  EXPECT_EQ(lamp_intensity(of.lamp, 0, of.values, {0, 1, 0}), 0);
  EXPECT_EQ(lamp_intensity(of.lamp, 1, of.values, {0, 1, 0}), 0);
  EXPECT_EQ(lamp_intensity(of.lamp, 0, of.values, {-0.6F, -0.8F, 0}), 0) << "the dark sector";
}

}  // namespace
}  // namespace torolux::protocol
