// SPDX-License-Identifier: MIT
// Proves: mirror, glass and panes follow the laws of reflection and refraction and Fresnel's equations (known values),
// and in the radiosity stage what they take is what the tally says.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>

#include "firmware/pe/specular.hpp"

namespace torolux::test {
namespace {

using glm::vec3;

glm::vec3 random_unit() {
  const auto number = [] { return static_cast<float>(*rc::gen::inRange(-1000, 1001)); };
  const vec3 v{number(), number(), number()};
  RC_PRE(glm::length(v) > 1.0F);
  return glm::normalize(v);
}

TEST(Specular, ReflectionKeepsTheAngleAndThePlane) {
  const bool holds = rc::check([] {
    const vec3 d = random_unit();
    const vec3 n = random_unit();
    const vec3 r = pe::reflect(d, n, n);
    RC_PRE(std::abs(glm::dot(d, n)) > 1e-4F);
    RC_ASSERT(std::abs(glm::length(r) - 1.0F) < 1e-6F);
    RC_ASSERT(std::abs(glm::dot(r, n) + glm::dot(d, n)) < 1e-6F);
    RC_ASSERT(glm::length(glm::cross(r - d, n)) < 2e-6F);
  });
  EXPECT_TRUE(holds);
}

// A shading normal never sends light through the flat polygon.
TEST(Specular, LightStaysOnItsSideWhateverTheShadingNormal) {
  const bool holds = rc::check([] {
    const vec3 d = random_unit();
    const vec3 flat = random_unit();
    const vec3 round = glm::normalize(flat + 0.7F * random_unit());
    RC_PRE(std::abs(glm::dot(d, flat)) > 1e-3F);
    const float side = glm::dot(d, flat) < 0 ? 1.0F : -1.0F;
    RC_ASSERT(glm::dot(pe::reflect(d, flat, round), flat) * side > 0.0F);
    const pe::Refraction out = pe::refract(d, flat, round, 1.5F);
    if (out.reflectance < 1.0F) RC_ASSERT(glm::dot(out.direction, flat) * side < 0.0F);
  });
  EXPECT_TRUE(holds);
}

TEST(Specular, RefractionFollowsSnell) {
  const bool holds = rc::check([] {
    const vec3 d = random_unit();
    const vec3 n = random_unit();
    const float eta = static_cast<float>(*rc::gen::inRange(40, 250)) / 100.0F;
    const float sin_in = glm::length(glm::cross(d, n));
    RC_PRE(std::abs(glm::dot(d, n)) > 1e-3F);
    const pe::Refraction out = pe::refract(d, n, n, eta);
    if (eta * sin_in > 1.0001F) RC_ASSERT(out.reflectance == 1.0F);
    if (out.reflectance == 1.0F) {
      RC_ASSERT(eta * sin_in > 0.9999F);
      return;
    }
    RC_ASSERT(out.reflectance >= 0.0F);
    RC_ASSERT(std::abs(glm::length(out.direction) - 1.0F) < 1e-6F);
    RC_ASSERT(std::abs(glm::length(glm::cross(out.direction, n)) - eta * sin_in) < 1e-5F);
    RC_ASSERT(std::abs(glm::dot(glm::cross(out.direction, n), d)) < 1e-5F);
  });
  EXPECT_TRUE(holds);
}

TEST(Specular, FresnelHasItsKnownValues) {
  const vec3 n{0, 0, 1};
  EXPECT_NEAR(pe::refract({0, 0, -1}, n, n, 1 / 1.5F).reflectance, 0.04F, 1e-6F);  // ((n-1)/(n+1))^2
  EXPECT_NEAR(pe::refract({0, 0, 1}, n, n, 1.5F).reflectance, 0.04F, 1e-6F);       // the same from inside
  // At Brewster's angle only the perpendicular part is reflected: half of ((n^2-1)/(n^2+1))^2.
  const float brewster = std::atan(1.5F);
  const float expected = 0.5F * std::pow(1.25F / 3.25F, 2.0F);
  EXPECT_NEAR(pe::refract({std::sin(brewster), 0, -std::cos(brewster)}, n, n, 1 / 1.5F).reflectance, expected, 1e-6F);
  // Total reflection from inside beyond asin(1/1.5) = 41.81 degrees.
  const auto inside = [&](float degrees) {
    const float a = degrees * 3.14159265F / 180;
    return pe::refract({std::sin(a), 0, std::cos(a)}, n, n, 1.5F).reflectance;
  };
  EXPECT_LT(inside(41.7F), 1.0F);
  EXPECT_EQ(inside(41.9F), 1.0F);
  // Both directions through a surface reflect alike (Stokes).
  const float in = 0.6F;
  const float out = std::asin(std::sin(in) / 1.5F);
  EXPECT_NEAR(pe::refract({std::sin(in), 0, -std::cos(in)}, n, n, 1 / 1.5F).reflectance,
              pe::refract({std::sin(out), 0, std::cos(out)}, n, n, 1.5F).reflectance, 1e-6F);
}

TEST(Specular, PaneHasItsKnownValues) {
  const vec3 n{0, 0, 1};
  const pe::PaneParts clear = pe::pane_parts({0, 0, -1}, n, 1.5F, vec3(1));
  EXPECT_NEAR(clear.reflected.x, 0.08F / 1.04F, 1e-6F);  // 2 F / (1 + F), F = 0.04
  EXPECT_NEAR(clear.passed.x, 0.96F / 1.04F, 1e-6F);
  EXPECT_EQ(clear.reflectance, clear.reflected.x);
  const pe::PaneParts grey = pe::pane_parts({0, 0, 1}, n, 1.5F, vec3(0.9F, 0.5F, 0));
  EXPECT_NEAR(grey.passed.x, 0.96F * 0.96F * 0.9F / (1 - 0.81F * 0.0016F), 1e-6F);  // as of a plate, all ways summed
  EXPECT_NEAR(grey.reflected.z, 0.04F, 1e-6F);                                      // of the first face alone
  EXPECT_EQ(grey.passed.z, 0.0F);
}

// In the radiosity stage one way is taken by chance, with what goes that way over the chance: never more than came.
TEST(Specular, PaneMakesNoLight) {
  const bool holds = rc::check([] {
    const vec3 d = random_unit();
    const vec3 n = random_unit();
    RC_PRE(std::abs(glm::dot(d, n)) > 1e-3F);
    const float index = static_cast<float>(*rc::gen::inRange(20, 500)) / 100.0F;
    const float through = static_cast<float>(*rc::gen::inRange(0, 101)) / 100.0F;
    const pe::PaneParts parts = pe::pane_parts(d, n, index, vec3(through));
    RC_ASSERT(parts.reflected.x >= 0.0F && parts.passed.x >= 0.0F);
    RC_ASSERT(parts.reflected.x + parts.passed.x <= 1.0F + 1e-6F);
    RC_ASSERT(parts.reflected.x <= parts.reflectance + 1e-6F);
    RC_ASSERT(parts.passed.x <= 1.0F - parts.reflectance + 1e-6F);
    if (through == 1.0F) RC_ASSERT(std::abs(parts.reflected.x + parts.passed.x - 1.0F) < 1e-5F);
  });
  EXPECT_TRUE(holds);
}

}  // namespace
}  // namespace torolux::test
