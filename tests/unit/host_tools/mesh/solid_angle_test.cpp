// SPDX-License-Identifier: MIT
// Proves that a surface's solid angle by crossings is the sum over its triangles: closed, open, and from all sides.
#include "host_tools/mesh/solid_angle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace torolux {
namespace {

/// A bumpy sphere of `rows` x 2 `rows` quadrangles, whose lowest `open` rows are left out.
struct Blob {
  std::vector<SolidAngle::Triangle> triangles;
  std::vector<std::array<Vec3d, 2>> border;

  Blob(std::size_t rows, std::size_t open) {
    const auto at = [rows](std::size_t row, std::size_t column) -> Vec3d {
      if (row == 0) return {0, 1, 0};
      if (row == rows) return {0, -1, 0};
      const double t = std::numbers::pi * static_cast<double>(row) / static_cast<double>(rows);
      const double p = std::numbers::pi * static_cast<double>(column % (2 * rows)) / static_cast<double>(rows);
      const double r = 1 + 0.2 * std::sin(5 * t) * std::cos(3 * p);
      return {r * std::sin(t) * std::cos(p), r * std::cos(t), r * std::sin(t) * std::sin(p)};
    };
    for (std::size_t row = 0; row + open < rows; ++row) {
      for (std::size_t column = 0; column < 2 * rows; ++column) {
        if (row > 0) triangles.push_back({at(row, column), at(row, column + 1), at(row + 1, column)});
        if (row + 1 < rows) triangles.push_back({at(row, column + 1), at(row + 1, column + 1), at(row + 1, column)});
        if (row + 1 + open == rows && open > 0) border.push_back({at(row + 1, column + 1), at(row + 1, column)});
      }
    }
  }

  double plain_sum(const Vec3d& point) const {
    double sum = 0;
    for (const auto& triangle : triangles) sum += vec::solid_angle(triangle, point);
    return sum;
  }
};

TEST(SolidAngle, IsTheSumOverTriangles) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-1.3, 1.3);
  for (const std::size_t open : {0U, 1U, 3U, 6U}) {
    const Blob blob(12, open);
    const SolidAngle fast(blob.triangles, blob.border);
    int inside = 0;
    for (int i = 0; i < 2000; ++i) {
      const Vec3d point{place(random), place(random), place(random)};
      const double sum = blob.plain_sum(point);
      // Sums of some hundred terms in doubles.
      ASSERT_NEAR(fast.seen_from(point), sum, 1e-9)
          << open << " rows open, at " << point[0] << " " << point[1] << " " << point[2];
      if (std::abs(sum) > 6) ++inside;
    }
    EXPECT_GT(inside, 100);
  }
}

/// Points on both sides of the surface, on lines through its corners along the rays.
TEST(SolidAngle, ARayThroughACornerIsCountedOnce) {
  const Blob blob(12, 0);
  const SolidAngle fast(blob.triangles, blob.border);
  for (const auto& triangle : blob.triangles) {
    for (const double back : {-0.9, -0.5, -0.01, 0.01, 0.5}) {
      const Vec3d point = vec::subtract(triangle[0], vec::scale(SolidAngle::kDirection, back));
      EXPECT_NEAR(fast.seen_from(point), blob.plain_sum(point), 1e-9);
    }
  }
}

}  // namespace
}  // namespace torolux
