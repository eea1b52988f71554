// SPDX-License-Identifier: MIT
// Irradiance over the normal: what samples determine is found, what they do not stays their mean.
#include "host_tools/irradiance/irradiance_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

constexpr double kLightAhead = 2;
const Vec3d kTowardsLight{0.3, -0.2, 0.8};
const Vec3d kOverPlace{0.5, 0.4, 0.0};

Vec3d irradiance(const Vec3d& normal, const Vec3d& offset) {
  const double light = kLightAhead + vec::dot(kTowardsLight, normal) + vec::dot(kOverPlace, offset);
  return {light, 2 * light, 0};
}

/// Normals within about 40 degrees of z at places all around, the one not a function of the other.
std::vector<IrradianceSample> samples_of_relief() {
  std::vector<IrradianceSample> samples;
  for (int i = -2; i <= 2; ++i) {
    for (int j = -2; j <= 2; ++j) {
      const Vec3d normal = vec::unit({0.3 * ((i + 2 * j + 20) % 5 - 2), 0.3 * ((2 * i - j + 20) % 5 - 2), 1});
      const Vec3d offset{0.1 + 0.3 * i, -0.1 + 0.3 * j, 0};
      samples.push_back({normal, offset, irradiance(normal, offset), 1.0 + 0.1 * i});
    }
  }
  return samples;
}

TEST(IrradianceFit, FollowsTheNormal) {
  const IrradianceFit fit = fit_irradiance(samples_of_relief());
  for (const Vec3d& towards : {Vec3d{0, 0, 1}, Vec3d{0.4, 0, 1}, Vec3d{-0.2, 0.4, 1}, Vec3d{0, -0.5, 1}}) {
    const Vec3d normal = vec::unit(towards);
    const Vec3d light = fit.facing(normal);
    const Vec3d expected = irradiance(normal, {0, 0, 0});
    // The ridge holds back some; the mean alone would be off by up to 0.15.
    EXPECT_NEAR(light[0], expected[0], 0.06);
    EXPECT_NEAR(light[1], 2 * light[0], 1e-12) << "channels are alike but for a factor";
    EXPECT_EQ(light[2], 0.0);
  }
}

TEST(IrradianceFit, FollowsThePlace) {
  std::vector<IrradianceSample> samples;
  for (int i = 0; i < 10; ++i) {  // all to one side, as at a border
    const Vec3d offset{0.1 * i, 0, 0};
    samples.push_back({{0, 0, 1}, offset, irradiance({0, 0, 1}, offset), 1});
  }
  const double mean = irradiance({0, 0, 1}, {0.45, 0, 0})[0];
  const double at_place = irradiance({0, 0, 1}, {0, 0, 0})[0];
  const double found = fit_irradiance(samples).facing({0, 0, 1})[0];
  EXPECT_LT(std::abs(found - at_place), 0.5 * std::abs(mean - at_place));
}

TEST(IrradianceFit, WhatIsNotDeterminedStaysTheMean) {
  const std::vector<IrradianceSample> one{{{0, 0, 1}, {0.5, 0, 0}, {3, 1, 2}, 0.1}};
  EXPECT_EQ(fit_irradiance(one).facing(vec::unit({1, 0, 1})), (Vec3d{3, 1, 2}));
  // On a plane nothing is known of other normals.
  std::vector<IrradianceSample> plane;
  for (const double x : {-0.5, 0.5}) plane.push_back({{0, 0, 1}, {x, 0, 0}, {1 + x, 1, 1}, 1});
  const IrradianceFit fit = fit_irradiance(plane);
  EXPECT_NEAR(fit.facing({0, 0, 1})[0], 1.0, 1e-12);
  EXPECT_NEAR(fit.facing(vec::unit({1, 0, 1}))[0], 1.0, 1e-12);
  EXPECT_EQ(fit_irradiance({}).facing({0, 0, 1}), (Vec3d{0, 0, 0}));
}

TEST(IrradianceFit, NoNormalGetsMoreOrLessThanTheSamples) {
  const std::vector<IrradianceSample> samples = samples_of_relief();
  Vec3d least = samples[0].irradiance;
  Vec3d most = least;
  for (const IrradianceSample& sample : samples) {
    for (std::size_t c = 0; c < 3; ++c) {
      least[c] = std::min(least[c], sample.irradiance[c]);
      most[c] = std::max(most[c], sample.irradiance[c]);
    }
  }
  const IrradianceFit fit = fit_irradiance(samples);
  EXPECT_EQ(fit.facing(vec::unit({-1, 1, -2})), least);
  EXPECT_EQ(fit.facing(vec::scale(vec::unit({1, -1, 1}), 5)), most);
}

}  // namespace
}  // namespace torolux
