// SPDX-License-Identifier: MIT
// Proves: filters weigh neighbours in rows and columns as told, hold the value of the edge beyond it, and blocks of
// halves are means, fewer pixels at the edges.
#include "host_tools/picture/plane.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace torolux {
namespace {

TEST(Plane, FilterWeighsAcrossAndDown) {
  Plane plane(5, 5);
  plane.values[2 * 5 + 2] = 1;
  const std::vector<double> across = {0.5, 0.25, 0};  // of the left neighbour, itself, the right one
  const std::vector<double> down = {0, 1, 2};
  const Plane result = filter(plane, across, down);
  EXPECT_FLOAT_EQ(result.values[2 * 5 + 3], 0.5F) << "its left neighbour is the bright one";
  EXPECT_FLOAT_EQ(result.values[2 * 5 + 2], 0.25F);
  EXPECT_FLOAT_EQ(result.values[2 * 5 + 1], 0);
  EXPECT_FLOAT_EQ(result.values[1 * 5 + 3], 1);
  EXPECT_FLOAT_EQ(result.values[3 * 5 + 3], 0);
}

TEST(Plane, BeyondTheEdgesIsTheEdge) {
  Plane plane(3, 2);
  plane.values = {1, 2, 3, 1, 2, 3};
  const auto weights = gaussian_weights(4, 12);  // far beyond on all sides
  const Plane result = filter(plane, std::vector<double>{1}, weights);
  for (std::size_t i = 0; i < 6; ++i) EXPECT_NEAR(result.values[i], plane.values[i], 1e-6);
  EXPECT_FLOAT_EQ(filter(plane, std::vector<double>{1, 0, 0}, std::vector<double>{1}).values[0], 1);
}

TEST(Plane, GaussianWeightsAddUpToOne) {
  const auto weights = gaussian_weights(1.5, 4);
  double sum = 0;
  for (const double weight : weights) sum += weight;
  EXPECT_NEAR(sum, 1, 1e-12);
  EXPECT_NEAR(weights[4] / weights[5], std::exp(1 / 4.5), 1e-12);
}

TEST(Plane, HalveOfOddEdges) {
  Plane plane(3, 3);
  plane.values = {1, 3, 5, 5, 7, 9, 2, 4, 8};
  const Plane half = halve(plane);
  EXPECT_EQ(half.width, 2U);
  EXPECT_EQ(half.height, 2U);
  EXPECT_EQ(half.values, (std::vector<float>{4, 7, 3, 8}));
}

}  // namespace
}  // namespace torolux
