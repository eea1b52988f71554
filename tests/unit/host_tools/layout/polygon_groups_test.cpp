// SPDX-License-Identifier: MIT
// Proves: a subspace's list has each of its polygons once, in groups whose boxes hold theirs, as many entries as are
// laid out for it; and no ray's box that touches a polygon's part of the cell is told apart from it.
#include "host_tools/layout/polygon_groups.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace torolux {
namespace {

using protocol::kBoxParts;

class ListTest : public ::testing::Test {
 protected:
  ListTest() : random_(7) {
    grid_.cells = {5, 5, 5};
    grid_.cell_size = {0.2F, 0.2F, 0.2F};
  }

  float uniform() { return static_cast<float>(random_() >> 8U) * 0x1p-24F; }

  /// Small ones in the cell (2, 2, 2), 0.4..0.6.
  std::vector<MeshTriangle> triangles(std::size_t count) {
    std::vector<MeshTriangle> all(count);
    for (MeshTriangle& t : all) {
      const protocol::Vec3f at{uniform(), uniform(), uniform()};
      for (auto& corner : t.corner) {
        for (std::size_t a = 0; a < 3; ++a) corner[a] = 0.4F + 0.17F * at[a] + 0.03F * uniform();
      }
    }
    return all;
  }

  Grid grid_;
  std::mt19937 random_;
};

TEST_F(ListTest, HasEachPolygonOnceInsideItsGroup) {
  for (const std::size_t count : {0U, 1U, 8U, 9U, 17U, 100U, 333U}) {
    const auto all = triangles(count);
    std::vector<std::uint32_t> numbers(count);
    for (std::uint32_t i = 0; i < count; ++i) numbers[i] = i;
    const auto list = list_polygons(all, numbers, grid_, grid_.index({2, 2, 2}));
    ASSERT_EQ(list.size(), listed_entries(count));
    std::vector<std::uint32_t> seen;
    for (std::size_t i = 0; i < list.size();) {
      std::size_t end = list.size();
      if ((list[i].polygon & protocol::kGroup) != 0) {
        const protocol::PackedBox box = list[i].box;
        end = i + 1 + (list[i].polygon & ~protocol::kGroup);
        ASSERT_LE(end, list.size());
        for (std::size_t k = ++i; k < end; ++k) EXPECT_EQ(protocol::box_around(box, list[k].box), box);
      }
      for (; i < end; ++i) seen.push_back(list[i].polygon);
    }
    std::sort(seen.begin(), seen.end());
    EXPECT_EQ(seen, numbers);
  }
}

// A ray's word as the PE makes it, against comparisons axis by axis: every pair of intervals on each axis.
TEST(PackedBox, TellsBoxesApartAsTheirPartsSay) {
  std::mt19937 random(3);
  int apart = 0;
  for (int i = 0; i < 200'000; ++i) {
    std::uint32_t ray = protocol::kBoxRayFlips;
    protocol::PackedBox polygon = 0;
    bool beside = false;
    for (std::uint32_t a = 0; a < 3; ++a) {
      std::array<std::uint32_t, 4> part{};
      for (auto& p : part) p = random() % kBoxParts;
      const auto [low, high] = std::minmax(part[0], part[1]);
      const auto [lowest, highest] = std::minmax(part[2], part[3]);
      ray ^= (high | low << protocol::kBoxUpperShift) << (a * protocol::kBoxAxisShift);
      polygon |= (lowest | (kBoxParts - 1U - highest) << protocol::kBoxUpperShift) << (a * protocol::kBoxAxisShift);
      EXPECT_EQ(protocol::lowest_part(polygon, a), lowest);
      EXPECT_EQ(protocol::highest_part(polygon, a), highest);
      beside = beside || high < lowest || low > highest;
    }
    ASSERT_EQ(protocol::boxes_apart(ray, polygon), beside);
    apart += beside ? 1 : 0;
  }
  EXPECT_GT(apart, 20'000);
  EXPECT_LT(apart, 180'000);
}

// The margin stands in the box: a polygon that ends just below a part's plane reaches into the part, and one that goes
// on outside the cell ends with it.
TEST_F(ListTest, BoxesAreGrownByTheMarginAndEndWithTheCell) {
  const float step = grid_.cell_size[0] / kBoxParts;
  const float plane = 0.4F + 5 * step;
  const std::array<protocol::Vec3f, 3> corner{{{plane - 1e-5F, 0.1F, 0.5F}, {0.45F, 0.1F, 0.5F}, {0.45F, 0.9F, 0.5F}}};
  const protocol::PackedBox box = protocol::box_in_cell(corner, grid_.cell_size, {2, 2, 2});
  EXPECT_EQ(protocol::highest_part(box, 0), 5U);
  EXPECT_EQ(protocol::lowest_part(box, 0), 3U);  // 0.05 / 0.0125 = 4, less the margin
  EXPECT_EQ(protocol::lowest_part(box, 1), 0U);
  EXPECT_EQ(protocol::highest_part(box, 1), 15U);
}

}  // namespace
}  // namespace torolux
