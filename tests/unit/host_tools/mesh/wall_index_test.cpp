// SPDX-License-Identifier: MIT
// Proves that a wall index leaves out no wall that meets a triangle, wherever walls begin and end.
#include "host_tools/mesh/wall_index.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace torolux {
namespace {

/// Whether a segment meets a triangle, which is wound counter-clockwise.
bool meets(const WallSegment& wall, const std::array<PlanePoint, 3>& corner) {
  double begin = 0;
  double end = 1;
  for (std::size_t e = 0; e < 3; ++e) {
    const PlanePoint& a = corner[e];
    const PlanePoint& b = corner[(e + 1) % 3];
    const auto side = [&](const PlanePoint& p) {
      return (b.b1 - a.b1) * (p.b2 - a.b2) - (b.b2 - a.b2) * (p.b1 - a.b1);
    };
    const double from = side(wall.from);
    const double to = side(wall.to);
    if (from < 0 && to < 0) return false;
    if (from < 0) begin = std::max(begin, from / (from - to));
    if (to < 0) end = std::min(end, from / (from - to));
  }
  return begin <= end;
}

class Numbers {
 public:
  /// Mostly within the triangle's square; some far beyond, some on lines between cells.
  double weight() {
    const double at = uniform_(random_);
    switch (random_() % 8) {
      case 0:
        return 20 * at - 10;
      case 1:
        return std::round(8 * at) / 8;
      default:
        return 1.2 * at - 0.1;
    }
  }
  WallSegment wall() {
    WallSegment wall{{weight(), weight()}, {weight(), weight()}};
    const auto kind = random_() % 6;
    if (kind == 0) wall.to.b1 = wall.from.b1;
    if (kind == 1) wall.to.b2 = wall.from.b2;
    if (kind == 2) wall.to = wall.from;
    return wall;
  }
  std::array<PlanePoint, 3> triangle() {
    const double size = std::exp2(-static_cast<double>(random_() % 8));
    const PlanePoint at{uniform_(random_) * (1 - size), uniform_(random_) * (1 - size)};
    return {{at, {at.b1 + size, at.b2}, {at.b1, at.b2 + size}}};
  }

 private:
  std::mt19937 random_{17};
  std::uniform_real_distribution<double> uniform_{0, 1};
};

TEST(WallIndex, FindsWhateverMeetsATriangle) {
  Numbers numbers;
  std::size_t found = 0;
  for (const std::size_t count : {1U, 20U, 300U}) {
    for (int trial = 0; trial < 20; ++trial) {
      std::array<std::vector<WallSegment>, 2> walls;
      for (std::size_t i = 0; i < count; ++i) walls[i % 2].push_back(numbers.wall());
      const WallIndex index({walls[0], walls[1]});
      for (int t = 0; t < 200; ++t) {
        const auto triangle = numbers.triangle();
        // Each alone, so that none is hidden behind another.
        for (const auto& side : walls) {
          for (const WallSegment& wall : side) {
            if (!meets(wall, triangle)) continue;
            ++found;
            EXPECT_TRUE(index.any_near(triangle, [&](const WallSegment& near) {
              return near.from.b1 == wall.from.b1 && near.from.b2 == wall.from.b2 && near.to.b1 == wall.to.b1 &&
                     near.to.b2 == wall.to.b2;
            }));
          }
        }
      }
    }
  }
  EXPECT_GT(found, 50'000U);
}

TEST(WallIndex, AsksLittleOfManyShortWalls) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(0, 1);
  std::vector<WallSegment> walls;
  for (int i = 0; i < 10'000; ++i) {
    const PlanePoint at{place(random), place(random)};
    walls.push_back({at, {at.b1 + 0.002, at.b2 - 0.003}});
  }
  const WallIndex index({walls, {}});
  std::size_t asked = 0;
  index.any_near({{{0.3, 0.3}, {0.31, 0.3}, {0.3, 0.31}}}, [&](const WallSegment&) {
    ++asked;
    return false;
  });
  EXPECT_GT(asked, 0U);
  EXPECT_LT(asked, 50U);
}

}  // namespace
}  // namespace torolux
