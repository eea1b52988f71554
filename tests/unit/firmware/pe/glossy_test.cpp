// SPDX-License-Identifier: MIT
// Proves: a glossy lobe's samples have the density that is said, against integrals and closed forms; and their weights
// reflect at most Ks.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "firmware/pe/glossy.hpp"
#include "firmware/protocol/random.hpp"
#include "tests/unit/firmware/pe/test_scene.hpp"

namespace torolux::test {
namespace {

using glm::vec3;

constexpr float kExponents[] = {0.0F, 1.0F, 7.5F, 60.0F, 1000.0F, 1e6F};

// The cosine is (1 - height)^(1 / (n + 1)), and the sine fits it: near the axis, too, where the angle of a narrow lobe
// is sqrt(-2 ln(1 - height) / (n + 1)).
TEST(Lobe, HeightGivesTheAngle) {
  for (const float exponent : kExponents) {
    for (std::uint32_t i = 0; i < 4096; ++i) {
      const float height = static_cast<float>(i) / 4096.0F;
      const vec3 way = pe::around({0, 0, 1}, 1 / (exponent + 1), height, 0.3F);
      const double expected = std::pow(1.0 - static_cast<double>(height), 1.0 / (static_cast<double>(exponent) + 1));
      ASSERT_NEAR(static_cast<double>(way.z), expected, 3e-7) << exponent << ' ' << height;
      const double sine = std::sqrt(1 - expected * expected);
      ASSERT_NEAR(std::hypot(static_cast<double>(way.x), static_cast<double>(way.y)), sine, 1e-6 * sine + 1e-9);
    }
  }
  const vec3 last = pe::around({0, 0, 1}, 1, 1.0F - 0x1p-24F, 0);
  EXPECT_NEAR(last.z, 0x1p-24F, 1e-7F);
}

TEST(Lobe, TurnsEvenlyAboutAnyAxis) {
  for (const vec3& axis : {vec3{0, 0, 1}, vec3{0, 0, -1}, vec3{0.6F, -0.8F, 0}, vec3{-0.48F, 0.64F, -0.6F}}) {
    vec3 sum(0.0F);
    float least = 2;
    vec3 before = pe::around(axis, 0.5F, 0.5F, 1.0F - 0x1p-24F);
    for (std::uint32_t i = 0; i < 360; ++i) {
      const vec3 way = pe::around(axis, 0.5F, 0.5F, static_cast<float>(i) / 360.0F);
      ASSERT_NEAR(glm::length(way), 1.0F, 1e-6F);
      ASSERT_NEAR(glm::dot(way, axis), std::sqrt(0.5F), 1e-6F);
      least = std::min(least, glm::dot(way, before));
      before = way;
      sum += way;
    }
    // Steps of one degree on a circle of radius sin 45 degrees.
    EXPECT_NEAR(least, 1 - 0.5F * (1 - std::cos(std::numbers::pi_v<float> / 180)), 2e-6F);
    EXPECT_NEAR(glm::length(sum / 360.0F - axis * std::sqrt(0.5F)), 0, 1e-5F);
  }
}

/// Mean weight of many samples, light coming at this angle to the normal [degrees].
double mean_weight(float exponent, double degrees) {
  const protocol::Material material = glossy_material(0.5F, 0.8F, exponent);
  const double angle = degrees * std::numbers::pi / 180;
  const vec3 in{static_cast<float>(std::sin(angle)), 0, static_cast<float>(-std::cos(angle))};
  const vec3 up{0, 0, 1};
  std::uint32_t drawn = 0;
  const auto random = [&drawn] { return protocol::uniform_float(protocol::hash_combine(5, drawn++)); };
  double sum = 0;
  constexpr std::uint32_t n = 1U << 18U;
  for (std::uint32_t i = 0; i < n; ++i) {
    const pe::LobeSample way = pe::sample_lobe(material, in, up, up, random(), random());
    EXPECT_NEAR(way.cosine, way.direction.z, 1e-6F);
    if (way.cosine > 0) sum += static_cast<double>(material.specular[0] * way.cosine);
  }
  return sum / n;
}

/// The same by integration: Ks (n + 2) / (2 pi) times the integral of cos^n(alpha) cos(theta) over the hemisphere.
double integral(double exponent, double degrees) {
  const double angle = degrees * std::numbers::pi / 180;
  constexpr int kRows = 4000;
  constexpr int kColumns = 400;
  double sum = 0;  // about the mirror direction: u = cos^(n+1) alpha, evenly
  for (int row = 0; row < kRows; ++row) {
    const double cosine = std::pow((row + 0.5) / kRows, 1 / (exponent + 1));
    const double sine = std::sqrt(1 - cosine * cosine);
    for (int column = 0; column < kColumns; ++column) {
      const double turn = 2 * std::numbers::pi * (column + 0.5) / kColumns;
      sum += std::max(0.0, cosine * std::cos(angle) + sine * std::cos(turn) * std::sin(angle));
    }
  }
  return 0.8 * (exponent + 2) / (exponent + 1) * sum / kRows / kColumns;
}

TEST(Lobe, WeightsReflectWhatTheLobeDoes) {
  for (const float exponent : {0.0F, 7.5F, 60.0F}) {
    for (const double degrees : {0.0, 45.0, 85.0}) {
      const double expected = integral(static_cast<double>(exponent), degrees);
      // Weights are below 1.6 with a deviation of 0.5 at most: 0.001 over the root of 2^18 samples.
      EXPECT_NEAR(mean_weight(exponent, degrees), expected, 0.004) << exponent << ' ' << degrees;
      EXPECT_LT(expected, 0.8 + 1e-4);
      if (degrees == 0) {
        EXPECT_NEAR(expected, 0.8, 1e-3);
      }
    }
  }
}

// From behind, and whatever the sign of the normals: the cosine is that to the side from which light comes.
TEST(Lobe, LiesOnTheSideOfTheLight) {
  const protocol::Material material = glossy_material(0, 0.8F, 1000);
  for (const float sign : {1.0F, -1.0F}) {
    for (const float side : {1.0F, -1.0F}) {
      const vec3 in = glm::normalize(vec3{0.4F, 0, -side});
      const pe::LobeSample way = pe::sample_lobe(material, in, {0, 0, sign}, {0, 0, -sign}, 0.4F, 0.7F);
      EXPECT_GT(way.cosine, 0.8F);
      EXPECT_NEAR(way.direction.z * side, way.cosine, 1e-6F);
    }
  }
}

}  // namespace
}  // namespace torolux::test
