// SPDX-License-Identifier: MIT
// Hemi-cube weights: exact sums, the reference values of the faces, each pixel against a fine quadrature.
#include "host_tools/layout/hemicube_weights.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>

#include "firmware/protocol/stores.hpp"

namespace torolux {
namespace {

TEST(HemicubeWeights, FacesHaveTheirReferenceFormFactors) {
  EXPECT_NEAR(4 * top_form_factor(1, 1), 0.554126423980, 1e-12);
  EXPECT_NEAR(2 * side_form_factor(1, 1), 0.111468394005, 1e-12);
}

TEST(HemicubeWeights, AddUpToOneExactly) {
  for (const std::uint32_t n : {2U, 4U, 6U, 16U, 62U, 128U, 256U}) {
    const auto weights = make_hemicube_weights(n);
    ASSERT_EQ(weights.size(), protocol::hemicube_weights(n));
    const auto middle = weights.begin() + static_cast<std::ptrdiff_t>(weights.size() / 2);
    const std::uint64_t top = std::accumulate(weights.begin(), middle, std::uint64_t{0});
    const std::uint64_t side = std::accumulate(middle, weights.end(), std::uint64_t{0});
    EXPECT_EQ(4 * top + 8 * side, std::uint64_t{1} << 32U) << n;
  }
}

TEST(HemicubeWeights, PixelsAgreeWithQuadrature) {
  constexpr std::uint32_t n = 8;
  constexpr int steps = 200;  // mid-points: error falls with steps^-2, to about 1e-7 of a pixel's factor
  const auto weights = make_hemicube_weights(n);
  for (std::uint32_t j = 0; j < n / 2; ++j) {
    for (std::uint32_t i = 0; i < n / 2; ++i) {
      double top = 0;
      double side = 0;
      for (int v = 0; v < steps; ++v) {
        for (int u = 0; u < steps; ++u) {
          const double x = (i + (u + 0.5) / steps) * 2 / n;
          const double y = (j + (v + 0.5) / steps) * 2 / n;
          const double r2 = x * x + y * y + 1;
          top += 1 / (std::numbers::pi * r2 * r2);
          side += y / (std::numbers::pi * r2 * r2);
        }
      }
      const double area = std::pow(2.0 / n / steps, 2);
      // Rounding to 2^-32 and what rounding leaves over: at most two units.
      EXPECT_NEAR(weights[j * n / 2 + i] * 0x1p-32, top * area, 1e-6 * top * area + 0x1p-31);
      EXPECT_NEAR(weights[n * n / 4 + j * n / 2 + i] * 0x1p-32, side * area, 1e-6 * side * area + 0x1p-31);
    }
  }
}

}  // namespace
}  // namespace torolux
