// SPDX-License-Identifier: MIT
// What surfaces of the path tracer do with light, against integrals and textbook values.
#include "tests/references/scattering.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/references/random.hpp"

namespace torolux::references {
namespace {

constexpr double kPi = std::numbers::pi;

/// Integral over the hemisphere about z by midpoints; function(direction) is weighted by solid angle.
template <class Function>
double integral(Function function) {
  constexpr int kRows = 1000;
  constexpr int kColumns = 400;
  double sum = 0;
  for (int row = 0; row < kRows; ++row) {
    const double cosine = (row + 0.5) / kRows;
    for (int column = 0; column < kColumns; ++column) {
      sum += function(around({0, 0, 1}, cosine, (column + 0.5) / kColumns));
    }
  }
  return sum * 2 * kPi / kRows / kColumns;
}

Vec view_at(double degrees) {
  return {std::sin(degrees * kPi / 180), 0, std::cos(degrees * kPi / 180)};
}

Reflection glossy(const Vec& view, double exponent) {
  const Vec up(0, 0, 1);
  return {up, mirror(-view, up, up), Colour::Constant(0.3), Colour::Constant(0.6), exponent};
}

/// Seen from above, kd + ks comes back; from the side less, as half of the lobe is below the surface, never more.
TEST(Glossy, ReflectsAtMostItsReflectance) {
  for (const double exponent : {1.0, 20.0, 200.0}) {
    for (const double degrees : {0.0, 30.0, 60.0, 85.0}) {
      const Reflection reflection = glossy(view_at(degrees), exponent);
      const double albedo = integral([&](const Vec& out) { return reflection.value(out)[0] * reflection.cosine(out); });
      EXPECT_LT(albedo, 0.9 + 1e-3) << exponent << " at " << degrees;
      EXPECT_GT(albedo, 0.3 - 1e-3);
      if (degrees > 0) continue;
      EXPECT_NEAR(albedo, 0.9, 2e-3) << exponent;  // midpoints of a narrow lobe: (n + 1) (n + 2) / 24e6
    }
  }
}

/// Samples fall as densely as density() says: the same integral by both.
TEST(Glossy, SamplesHaveTheDensityThatIsSaid) {
  for (const double exponent : {2.0, 50.0}) {
    const Reflection reflection = glossy(view_at(50), exponent);
    Samples samples(1, 1);
    const auto value = [&](const Vec& out) { return reflection.value(out)[0] * reflection.cosine(out); };
    double sum = 0;
    double above = 0;
    constexpr std::uint32_t kSamples = 1U << 17U;
    for (std::uint32_t i = 0; i < kSamples; ++i) {
      samples.begin(i);
      const double choice = samples.pair(0)[0];
      const Vec out = reflection.sample(choice, samples.pair(1));
      if (reflection.cosine(out) <= 0) continue;
      above += 1.0 / kSamples;
      sum += value(out) / reflection.density(out) / kSamples;
    }
    // Weights are below 1; their spread over the root of the number of samples is below 0.001.
    EXPECT_NEAR(sum, integral(value), 0.003);
    EXPECT_NEAR(above, integral([&](const Vec& out) { return reflection.density(out); }), 0.003);
  }
}

TEST(Glossy, IsReciprocal) {
  const Vec a = view_at(20);
  const Vec b = around({0, 0, 1}, 0.4, 0.3);
  EXPECT_NEAR(glossy(a, 7).value(b)[0], glossy(b, 7).value(a)[0], 1e-12);
}

TEST(Glass, FollowsSnellAndFresnel) {
  const Vec up(0, 0, 1);
  for (const double eta : {1 / 1.5, 1.5}) {
    const Vec in = -view_at(35);
    const GlassWays ways = glass(in, up, up, eta);
    EXPECT_NEAR(ways.refracted.head<2>().norm(), eta * in.head<2>().norm(), 1e-12);
    EXPECT_LT(ways.refracted.z(), 0);
  }
  EXPECT_NEAR(glass(-up, up, up, 1 / 1.5).reflectance, 0.04, 1e-12);
  EXPECT_NEAR(glass(-up, -up, -up, 1.5).reflectance, 0.04, 1e-12);
  // At Brewster's angle, atan(1.5), only half of the light, polarised across, is reflected: sin^2(2 * angle - 90) / 2.
  const double brewster = std::atan(1.5) * 180 / kPi;
  const double across = std::sin((2 * brewster - 90) * kPi / 180);
  EXPECT_NEAR(glass(-view_at(brewster), up, up, 1 / 1.5).reflectance, across * across / 2, 1e-12);
  // The critical angle is asin(1 / 1.5) = 41.81 degrees.
  EXPECT_LT(glass(-view_at(41.8), up, up, 1.5).reflectance, 1);
  EXPECT_EQ(glass(-view_at(41.82), up, up, 1.5).reflectance, 1);
}

TEST(Mirror, NeverReflectsThroughTheFlatSurface) {
  const Vec up(0, 0, 1);
  EXPECT_LT((mirror(-view_at(30), up, up) - around(up, std::cos(kPi / 6), 0.5)).norm(), 1e-12);
  const Vec tilted = view_at(-20);  // would send light that comes at 80 degrees below the surface
  EXPECT_GT(mirror(-view_at(80), up, tilted).z(), 0);
}

/// A pair's points lie one in each of 2^a by 2^b boxes for every a + b = 8.
TEST(Samples, AreSpreadEvenly) {
  for (const unsigned columns : {1U, 4U, 16U, 256U}) {
    Samples samples(3, 17);
    std::vector<int> count(256, 0);
    for (std::uint32_t i = 0; i < 256; ++i) {
      samples.begin(i);
      const auto [x, y] = samples.pair(5);
      ASSERT_TRUE(x >= 0 && x < 1 && y >= 0 && y < 1);
      ++count[static_cast<unsigned>(x * columns) * (256 / columns) + static_cast<unsigned>(y * (256.0 / columns))];
    }
    for (const int n : count) EXPECT_EQ(n, 1) << columns << " columns";
  }
}

}  // namespace
}  // namespace torolux::references
