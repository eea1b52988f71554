// SPDX-License-Identifier: MIT
// Proves: turns and heights go there and back; directions are of unit length and drawn so that their mean is the
// integral over the sphere, whatever the radiance; the sun is seen within its disc and nowhere else; nothing is
// interpolated across the horizon.
#include "firmware/protocol/sky.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "firmware/protocol/stratified.hpp"

namespace torolux::protocol {
namespace {

constexpr float kTangent = 0.0046F;

SkyFrame frame_of(bool sun) {
  const float r = std::sqrt(0.5F);
  SkyFrame frame{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}, {r, r, 0}, {0, 0, 1}, {r, -r, 0}, 0, {1, 1, 1}};
  if (sun) frame.sun_tangent = kTangent;
  return frame;
}

/// Radiance 1 above, 0.25 below; a third of all draws go to the sun where there is one.
std::vector<SkyEntry> half_and_half(bool sun) {
  std::vector<SkyEntry> sky;
  const double of_cells = sun ? 2.0 / 3 : 1;
  for (std::uint32_t i = 0; i < kSkyCells; ++i) {
    const float radiance = i < kSkyCells / 2 ? 0.25F : 1.0F;
    sky.push_back(
        {{radiance, radiance / 2, 0}, static_cast<std::uint32_t>(of_cells * (i + 1) / kSkyCells * 0x1p32 - 1)});
  }
  sky.push_back({{sun ? 1000.0F : 0.0F, 0, 0}, 0xFFFF'FFFFU});
  return sky;
}

TEST(Sky, TurnsGoThereAndBack) {
  for (std::uint32_t i = 0; i < 4000; ++i) {
    const float turn = static_cast<float>(i) * 0.001F;
    const SkyHorizontal h = sky_horizontal(turn);
    EXPECT_NEAR(sky_turn(h.x, h.y), turn, 1e-5);
    EXPECT_NEAR(h.angle_by_turn, 1 / (h.x * h.x + h.y * h.y), 1e-5);
  }
}

struct Means {
  double height_weighted = 0, all = 0, blue = 0;
};

Means means_of(const SkyFrame& frame, const std::vector<SkyEntry>& sky) {
  Means means;
  constexpr std::uint32_t kDraws = 1U << 17U;
  for (std::uint32_t i = 0; i < kDraws; ++i) {
    const StratifiedPair pair = stratified_pair(i, 5);
    const SkySample sample = sample_sky(frame, sky, pair.x, uniform_float(pair.y));
    EXPECT_NEAR(dot(sample.direction, sample.direction), 1, 1e-5);
    means.all += static_cast<double>(sample.radiance_by_solid_angle[0]) / kDraws;
    means.blue += static_cast<double>(sample.radiance_by_solid_angle[1]) / kDraws;
    const double height = std::max(0.0F, dot(sample.direction, frame.up));
    means.height_weighted += height * static_cast<double>(sample.radiance_by_solid_angle[0]) / kDraws;
  }
  return means;
}

TEST(Sky, DrawsHaveTheMeanOfTheSphere) {
  const Means means = means_of(frame_of(false), half_and_half(false));
  EXPECT_NEAR(means.all, 2 * std::numbers::pi * 1.25, 0.001);
  EXPECT_NEAR(means.blue, std::numbers::pi * 1.25, 0.001);
  EXPECT_NEAR(means.height_weighted, std::numbers::pi, 0.001) << "a level plane under a uniform sky";
}

TEST(Sky, TheSunAddsItsRadianceTimesItsSolidAngle) {
  const Means means = means_of(frame_of(true), half_and_half(true));
  const double irradiance = 1000 * std::numbers::pi * double{kTangent} * double{kTangent};
  EXPECT_NEAR(means.all, 2 * std::numbers::pi * 1.25 + irradiance, 0.001);
  EXPECT_NEAR(means.height_weighted, std::numbers::pi + irradiance * std::sqrt(0.5), 0.001);
}

TEST(Sky, TheSunIsSeenWithinItsDisc) {
  const SkyFrame frame = frame_of(true);
  const std::vector<SkyEntry> sky = half_and_half(true);
  const auto seen = [&](float aside) {
    const Vec3f way = combined(frame.sun, 1, frame.sun_x, aside, frame.sun_y, 0);
    const float inverse = 1.0F / std::sqrt(dot(way, way));
    return sky_radiance(frame, sky, {way[0] * inverse, way[1] * inverse, way[2] * inverse})[0];
  };
  EXPECT_FLOAT_EQ(seen(0), 1001);
  EXPECT_FLOAT_EQ(seen(0.99F * kTangent), 1001);
  EXPECT_FLOAT_EQ(seen(1.01F * kTangent), 1);
  EXPECT_FLOAT_EQ(sky_radiance(frame, sky, {-frame.sun[0], -frame.sun[1], -frame.sun[2]})[0], 0.25F);
  for (std::uint32_t i = 0; i < 1000; ++i) {
    const StratifiedPair pair = stratified_pair(i, 9);
    const Vec3f drawn = sun_direction(frame, uniform_float(pair.x), uniform_float(pair.y));
    EXPECT_GT(sky_radiance(frame, sky, drawn)[0], 1000) << i;
  }
}

TEST(Sky, NothingIsInterpolatedAcrossTheHorizon) {
  const SkyFrame frame = frame_of(false);
  const std::vector<SkyEntry> sky = half_and_half(false);
  EXPECT_FLOAT_EQ(sky_radiance(frame, sky, {1, 1e-4F, 0})[0], 1);
  EXPECT_FLOAT_EQ(sky_radiance(frame, sky, {0, -1e-4F, 1})[0], 0.25F);
  EXPECT_FLOAT_EQ(sky_radiance(frame, sky, {0, 1, 0})[0], 1);
  EXPECT_FLOAT_EQ(sky_radiance(frame, sky, {0, -1, 0})[0], 0.25F);
}

/// Between the middles of cells in proportion, round the whole turn.
TEST(Sky, IsSmoothAlongTheTurn) {
  const SkyFrame frame = frame_of(false);
  std::vector<SkyEntry> sky = half_and_half(false);
  for (std::uint32_t i = 0; i < kSkyCells; ++i) {
    const auto sector = static_cast<float>(i % kSkySectors);
    sky[i].radiance[0] = std::fabs(sector - 31.5F);
  }
  float before = sky_radiance(frame, sky, {1, 0.1F, 0.001F})[0];
  for (int i = 0; i < 6400; ++i) {
    const SkyHorizontal h = sky_horizontal(static_cast<float>(i) * (4.0F / 6400));
    const float now = sky_radiance(frame, sky, {h.x, 0.1F, -h.y})[0];
    EXPECT_LT(std::fabs(now - before), 0.05F) << i;
    before = now;
  }
}

}  // namespace
}  // namespace torolux::protocol
