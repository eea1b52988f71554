// SPDX-License-Identifier: MIT
// Light over an element: as it is at the corners there, the same on both sides of an edge, as the square root of the
// distance from a concave edge of the scene; linear where none is near.
#include "firmware/protocol/element_light.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

namespace torolux::protocol {
namespace {

constexpr ConcaveCorners kAll = 0b111;
constexpr std::array<ConcaveCorners, 11> kAny{
    0, 1, 2, 3, 4, 5, 6, kAll, 0b011 | kSideInside, 0b101 | kSideInside, 0b110 | kSideInside};

Weights any_point(std::mt19937& random) {
  std::uniform_real_distribution<float> uniform(0, 1);
  const float a = uniform(random);
  const float b = uniform(random);
  return a + b <= 1 ? Weights{1 - a - b, a, b} : Weights{a + b - 1, 1 - a, 1 - b};
}

float sum(const Weights& w) {
  return w.b0 + w.b1 + w.b2;
}

TEST(ElementLight, WeightsAddUpToOneAndAreNeverNegative) {
  std::mt19937 random(1);
  for (const ConcaveCorners concave : kAny) {
    for (int i = 0; i < 1000; ++i) {
      const Weights light = light_weights(concave, any_point(random));
      EXPECT_NEAR(sum(light), 1, 1e-6F) << concave;  // some roundings of 2^-24
      EXPECT_GE(std::min({light.b0, light.b1, light.b2}), -1e-6F) << concave;
    }
  }
}

TEST(ElementLight, CornersShowTheirOwn) {
  for (const ConcaveCorners concave : kAny) {
    const auto expect = [concave](const Weights& at) {
      const Weights light = light_weights(concave, at);
      EXPECT_EQ(light.b0, at.b0) << concave;
      EXPECT_EQ(light.b1, at.b1) << concave;
      EXPECT_EQ(light.b2, at.b2) << concave;
    };
    expect({1, 0, 0});
    expect({0, 1, 0});
    expect({0, 0, 1});
  }
}

TEST(ElementLight, LinearWhereNoCornerOrEachLiesOnAConcaveEdge) {
  std::mt19937 random(2);
  for (const ConcaveCorners concave : {ConcaveCorners{0}, kAll}) {
    const Weights at = any_point(random);
    const Weights light = light_weights(concave, at);
    EXPECT_EQ(light.b0, at.b0);
    EXPECT_EQ(light.b1, at.b1);
    EXPECT_EQ(light.b2, at.b2);
  }
}

// The edge's ends have 1, the third corner 3: at a tenth of the way light has risen by sqrt(0.1) of that, wherever
// along the edge. Likewise from a corner to the side opposite.
TEST(ElementLight, RisesAsTheRootOfTheDistance) {
  for (const float along : {0.0F, 0.3F, 1.0F}) {
    const Weights side = light_weights(0b011, {0.9F * (1 - along), 0.9F * along, 0.1F});
    EXPECT_NEAR(side.b0 + side.b1 + 3 * side.b2, 1 + 2 * std::sqrt(0.1F), 1e-5F);
    const Weights corner = light_weights(0b100, {0.1F * (1 - along), 0.1F * along, 0.9F});
    EXPECT_NEAR(3 * corner.b0 + 3 * corner.b1 + corner.b2, 1 + 2 * std::sqrt(0.1F), 1e-5F);
  }
}

// An element with two corners on a concave edge and its neighbour with one share an edge from there.
TEST(ElementLight, NeighboursAgreeOnTheirEdge) {
  for (int i = 0; i <= 100; ++i) {
    const float t = static_cast<float>(i) / 100;
    const Weights one = light_weights(0b001, {1 - t, t, 0});
    const Weights two = light_weights(0b101, {1 - t, t, 0});
    EXPECT_NEAR(one.b0, two.b0, 1e-6F);
    EXPECT_NEAR(one.b1, two.b1, 1e-6F);
    EXPECT_EQ(two.b2, 0.0F);
  }
}

// In a corner of a room an element's side between two edges lies inside the surface: light is linear along it, as in
// the element beyond, and goes as the root along the others.
TEST(ElementLight, ASideInsideIsLinearAlongItself) {
  for (int i = 0; i <= 100; ++i) {
    const float t = static_cast<float>(i) / 100;
    const Weights along = light_weights(0b011 | kSideInside, {1 - t, t, 0});
    EXPECT_NEAR(along.b0, 1 - t, 1e-6F);
    EXPECT_NEAR(along.b1, t, 1e-6F);
    const Weights away = light_weights(0b011 | kSideInside, {1 - t, 0, t});
    const Weights other = light_weights(0b001, {1 - t, 0, t});
    EXPECT_NEAR(away.b0, other.b0, 1e-6F);
    EXPECT_NEAR(away.b2, other.b2, 1e-6F);
  }
}

TEST(ElementLight, MarksKeepTheLight) {
  for (const ConcaveCorners concave : kAny) {
    CornerIrradiance light{{{{0.5F, 0.25F, 1}, {1, 2, 3}, {0, 0, 0}}}};
    mark_concave(light, concave);
    EXPECT_EQ(concave_corners(light), concave);
    EXPECT_EQ(irradiance_at(light, 0), (Vec3f{0.5F, 0.25F, 1}));
    EXPECT_EQ(irradiance_at(light, 1), (Vec3f{1, 2, 3}));
    EXPECT_FALSE(std::signbit(irradiance_at(light, 2)[0])) << "what is dark, too";
  }
}

}  // namespace
}  // namespace torolux::protocol
