// SPDX-License-Identifier: MIT
// Proves that no point near a stretch of a line is missed, wherever points lie, and that few others are found.
#include "host_tools/scene/point_tree.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>

namespace torolux {
namespace {

double distance(const Vec3d& p, const Vec3d& a, const Vec3d& b) {
  const Vec3d along = vec::subtract(b, a);
  const double squared = vec::dot(along, along);
  const double way = squared > 0 ? std::clamp(vec::dot(vec::subtract(p, a), along) / squared, 0.0, 1.0) : 0.0;
  return vec::length(vec::subtract(p, vec::add(a, vec::scale(along, way))));
}

std::vector<std::uint32_t> all_of(const std::vector<Vec3d>& points) {
  std::vector<std::uint32_t> members(points.size());
  std::iota(members.begin(), members.end(), 0U);
  return members;
}

TEST(PointTree, MissesNoneWhereverTheyLie) {
  std::mt19937 random(7);
  const auto whole = [&random](unsigned below) { return static_cast<double>(random() % below); };
  // On a lattice, so that many have one coordinate, or all, in common; in a plane; on a line.
  for (const std::array<unsigned, 3>& size : {std::array{20U, 20U, 20U}, {50U, 50U, 1U}, {1U, 300U, 1U}}) {
    std::vector<Vec3d> points;
    for (int i = 0; i < 2000; ++i) points.push_back({whole(size[0]) - 9, whole(size[1]) - 9, whole(size[2]) - 9});
    const PointTree tree(points, all_of(points));
    std::vector<std::uint32_t> found;
    for (int i = 0; i < 300; ++i) {
      const Vec3d& a = points[random() % points.size()];
      const Vec3d& b = points[random() % points.size()];
      for (const double near : {1e-6, 1.0, 2.5}) {
        tree.find_near(a, b, near, found);
        std::ranges::sort(found);
        for (std::uint32_t p = 0; p < points.size(); ++p)
          ASSERT_TRUE(distance(points[p], a, b) > near || std::ranges::binary_search(found, p)) << i << ' ' << p;
        EXPECT_EQ(std::ranges::adjacent_find(found), found.end());
      }
    }
  }
}

TEST(PointTree, FindsFewOthers) {
  std::vector<Vec3d> points;
  for (int x = 0; x < 300; ++x)
    for (int y = 0; y < 300; ++y) points.push_back({x / 300.0, y / 300.0, 0});
  const PointTree tree(points, all_of(points));
  std::vector<std::uint32_t> found;
  tree.find_near({0.5, 0.5, 0}, {0.51, 0.51, 0}, 1e-6, found);
  EXPECT_LT(found.size(), 100U);
  // A line across all has boxes of eight beside it, not those of the whole plane.
  tree.find_near({0, 0, 0}, {1, 1, 0}, 1e-6, found);
  EXPECT_LT(found.size(), 30U * 300);
  tree.find_near({0, 0, 1}, {1, 1, 1}, 1e-6, found);
  EXPECT_TRUE(found.empty());
}

TEST(PointTree, OfNoPointsNoneIsFound) {
  std::vector<std::uint32_t> found{5};
  PointTree({}, {}).find_near({0, 0, 0}, {1, 1, 1}, 1, found);
  EXPECT_TRUE(found.empty());
}

}  // namespace
}  // namespace torolux
