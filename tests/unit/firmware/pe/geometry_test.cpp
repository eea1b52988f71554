// SPDX-License-Identifier: MIT
// Proves: the triangle test's hand cases, edges and vertices inclusive, sides by winding; and the walk's: the intervals
// of the subspaces along a ray meet exactly, whoever computes them and wherever it stops; a point's cell is the one
// between whose planes it lies; and the map of cells knows what stands where.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cmath>
#include <limits>
#include <optional>

#include "firmware/pe/intersect.hpp"
#include "firmware/pe/traverse.hpp"
#include "firmware/pe/walk.hpp"
#include "firmware/protocol/random.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "tests/unit/firmware/pe/test_scene.hpp"

namespace torolux::test {
namespace {

using pe::Crossing;
using pe::Inverse;
using pe::Segment;
using pe::Shear;

protocol::Polygon triangle(const protocol::Vec3f& a, const protocol::Vec3f& b, const protocol::Vec3f& c) {
  protocol::Polygon p{};
  p.corner = {a, b, c};
  return p;
}

bool meets(const glm::vec3& o, const glm::vec3& d, const protocol::Polygon& p, Crossing& c) {
  return pe::cross_triangle(Shear(o, d, Inverse(d)), p, c);
}

TEST(Intersect, MeetsInsideAndMissesOutside) {
  const auto p = triangle({0, 0, 0.5F}, {1, 0, 0.5F}, {0, 1, 0.5F});
  Crossing c{};
  ASSERT_TRUE(meets({0.25F, 0.5F, 0}, {0, 0, 1}, p, c));
  EXPECT_EQ(c.t, 0.5F);
  EXPECT_LT(c.sum, 0) << "from behind: the front is where corners run counter-clockwise";
  EXPECT_EQ(c.v / c.sum, 0.25F);
  EXPECT_EQ(c.w / c.sum, 0.5F);
  ASSERT_TRUE(meets({0.25F, 0.5F, 1}, {0, 0, -1}, p, c));
  EXPECT_EQ(c.t, 0.5F);
  EXPECT_GT(c.sum, 0);
  EXPECT_FALSE(meets({0.75F, 0.5F, 0}, {0, 0, 1}, p, c));
  EXPECT_FALSE(meets({-0.001F, 0.5F, 0}, {0, 0, 1}, p, c));
  EXPECT_FALSE(meets({0.25F, 0.5F, 0.5F}, {1, 0, 0}, p, c)) << "seen edge on";
  ASSERT_TRUE(meets({0.25F, 0.25F, 1}, {0, 0, 1}, p, c)) << "behind the origin: a distance below zero";
  EXPECT_EQ(c.t, -0.5F);
}

// The sides of all axes and signs agree with the normal.
TEST(Intersect, SideFollowsTheNormalFromEveryDirection) {
  const bool holds = rc::check([] {
    const auto number = [] { return static_cast<float>(*rc::gen::inRange(0, 1 << 16)) * 0x1p-16F; };
    const auto p =
        triangle({number(), number(), number()}, {number(), number(), number()}, {number(), number(), number()});
    const glm::vec3 area = glm::cross(pe::to_vector(p.corner[1]) - pe::to_vector(p.corner[0]),
                                      pe::to_vector(p.corner[2]) - pe::to_vector(p.corner[0]));
    RC_PRE(glm::length(area) > 1e-3F);
    const glm::vec3 target =
        (pe::to_vector(p.corner[0]) + pe::to_vector(p.corner[1]) + pe::to_vector(p.corner[2])) / 3.0F;
    const glm::vec3 origin{number(), number(), number()};
    RC_PRE(glm::length(target - origin) > 1e-2F);
    const glm::vec3 d = glm::normalize(target - origin);
    RC_PRE(std::abs(glm::dot(d, glm::normalize(area))) > 1e-2F);
    Crossing c{};
    RC_ASSERT(meets(origin, d, p, c));
    RC_ASSERT((c.sum > 0) == (glm::dot(d, area) < 0));
    RC_ASSERT(std::abs(c.t - glm::length(target - origin)) < 1e-4F);
    RC_ASSERT(std::abs(c.v / c.sum - 1.0F / 3.0F) < 1e-2F);
    RC_ASSERT(std::abs(c.w / c.sum - 1.0F / 3.0F) < 1e-2F);
  });
  EXPECT_TRUE(holds);
}

TEST(Intersect, EdgesAndCornersBelongToEveryTriangleThatHasThem) {
  const auto lower = triangle({0, 0, 0.5F}, {1, 0, 0.5F}, {1, 1, 0.5F});
  const auto upper = triangle({0, 0, 0.5F}, {1, 1, 0.5F}, {0, 1, 0.5F});
  Crossing c{};
  for (const float at : {0.0F, 0.3F, 0.5F, 1.0F}) {
    EXPECT_TRUE(meets({at, at, 0}, {0, 0, 1}, lower, c)) << at;
    EXPECT_TRUE(meets({at, at, 0}, {0, 0, 1}, upper, c)) << at;
  }
}

// Edge functions that cancel in float are computed exactly.
TEST(Intersect, CancellationIsResolvedExactly) {
  Crossing c{};
  // w = bx*ay - by*ax with products that round to the same float but differ.
  const float a = 1.0F + 0x1p-13F;
  const float b = 1.0F + 0x1p-12F;
  ASSERT_EQ(a * a, b * 1.0F) << "the case needs products that round to one float";
  pe::resolve_edges(1.0F, a, a, b, -1, 0.25F, c);
  EXPECT_EQ(c.w, 0x1p-26F);
}

struct GridCase {
  protocol::StageLayout layout{};
  Segment segment{};
};

GridCase random_grid_case() {
  GridCase g;
  const auto number = [] { return static_cast<float>(*rc::gen::inRange(0, (1 << 16) + 1)) * 0x1p-16F; };
  for (std::size_t a = 0; a < 3; ++a) {
    g.layout.cells[a] = *rc::gen::inRange<std::uint32_t>(1, 40);
    g.layout.cell_size[a] = (0.3F + 0.7F * number()) / static_cast<float>(g.layout.cells[a]);
    g.segment.origin[static_cast<int>(a)] = number() * g.layout.cell_size[a] * static_cast<float>(g.layout.cells[a]);
  }
  glm::vec3 d{number() - 0.5F, number() - 0.5F, number() - 0.5F};
  const int zero = *rc::gen::inRange(0, 6);
  if (zero < 3) d[zero] = 0;
  RC_PRE(glm::length(d) > 1e-3F);
  g.segment.direction = glm::normalize(d);
  g.segment.polygon = protocol::kNoPolygon;
  g.segment.first = true;
  return g;
}

/// A map of so many cells, of which a ray stops in those that `stops` says.
struct TestMap {
  std::vector<protocol::CellWord> words;
  template <class Stops>
  TestMap(std::uint32_t cells, const Stops& stops) : words(protocol::cell_words(cells)) {
    for (std::uint32_t c = 0; c < cells; ++c) words[c / 32].stops |= stops(c) ? 1U << (c % 32) : 0U;
  }
  pe::CellMap view() const { return {words, {}}; }
};

std::uint32_t cells_of(const protocol::StageLayout& layout) {
  return layout.cells[0] * layout.cells[1] * layout.cells[2];
}

void assert_same(const pe::Walk& walk, const pe::Walk& other) {
  RC_ASSERT(pe::bits(walk.t_in()) == pe::bits(other.t_in()));
  RC_ASSERT(pe::bits(walk.t_out()) == pe::bits(other.t_out()));
  RC_ASSERT(walk.index() == other.index());
  RC_ASSERT(walk.place() == other.place());
  RC_ASSERT(walk.entry_axis() == other.entry_axis());
  RC_ASSERT(walk.goes_outside() == other.goes_outside());
  RC_ASSERT(walk.came_from_outside() == other.came_from_outside());
}

Segment handed_over(const Segment& segment, const pe::Walk& walk) {
  Segment handed = segment;
  handed.place = walk.place();
  handed.first = walk.first();
  handed.entry_axis = walk.entry_axis();
  return handed;
}

// The partition: each interval begins at the very float at which the last one ended, also when it is computed afresh
// from the entry axis alone, as at a hand-over; ends never fall; the walk leaves the grid.
TEST(Walk, IntervalsOfTheSubspacesMeetExactly) {
  const bool holds = rc::check([] {
    GridCase g = random_grid_case();
    const TestMap all(cells_of(g.layout), [](std::uint32_t) { return true; });
    g.segment.place = pe::cell_of(g.layout, g.segment.origin);
    pe::Walk walk(g.layout, g.segment);
    RC_ASSERT(walk.first());
    RC_ASSERT(walk.index() == pe::cell_index(g.layout, g.segment.place));
    RC_ASSERT(walk.t_out() >= 0.0F);
    std::uint32_t steps = 0;
    for (float last = walk.t_out(); walk.advance(all.view()); last = walk.t_out(), ++steps) {
      RC_ASSERT(steps < 120U);
      RC_ASSERT(!walk.first());
      RC_ASSERT(pe::bits(walk.t_in()) == pe::bits(last));
      RC_ASSERT(walk.t_out() >= last);
      RC_ASSERT(walk.index() == pe::cell_index(g.layout, walk.place()));
      assert_same(pe::Walk(g.layout, handed_over(g.segment, walk)), walk);
    }
    RC_ASSERT(walk.goes_outside());
  });
  EXPECT_TRUE(holds);
}

// Stepping over cells changes nothing, to the bit: whoever stops in few of them comes to those as who stops in all.
TEST(Walk, StepsOverCellsAsIfItStopped) {
  const bool holds = rc::check([] {
    GridCase g = random_grid_case();
    const auto seed = *rc::gen::arbitrary<std::uint32_t>();
    const auto often = *rc::gen::inRange<std::uint32_t>(1, 12);
    const auto stops = [=](std::uint32_t c) { return protocol::hash_combine(seed, c) % often == 0; };
    const TestMap all(cells_of(g.layout), [](std::uint32_t) { return true; });
    const TestMap some(cells_of(g.layout), stops);
    g.segment.place = pe::cell_of(g.layout, g.segment.origin);
    pe::Walk walk(g.layout, g.segment);
    std::optional<pe::Walk> leaping(std::in_place, g.layout, g.segment);
    while (walk.advance(all.view())) {
      if (!stops(walk.index())) continue;
      RC_ASSERT(leaping->advance(some.view()));
      assert_same(*leaping, walk);
      leaping.emplace(g.layout, handed_over(g.segment, *leaping));  // at another PE
    }
    RC_ASSERT(!leaping->advance(some.view()));
  });
  EXPECT_TRUE(holds);
}

// Of equal distances x comes before y before z.
TEST(Walk, CornersAreCrossedXBeforeYBeforeZ) {
  protocol::StageLayout layout{};
  layout.cells = {2, 2, 2};
  layout.cell_size = {0.5F, 0.5F, 0.5F};
  const float d = 1.0F / std::sqrt(3.0F);
  const Segment s{{0.25F, 0.25F, 0.25F}, {d, d, d}, 0, protocol::kNoPolygon, true, 0};
  pe::Walk walk(layout, s);
  const TestMap all(8, [](std::uint32_t) { return true; });
  for (std::uint8_t axis = 0; axis < 3; ++axis) {
    ASSERT_TRUE(walk.advance(all.view()));
    ASSERT_EQ(walk.entry_axis(), axis);
  }
  EXPECT_EQ(walk.place(), protocol::cell_code(1, 1, 1));
  EXPECT_FALSE(walk.advance(all.view()));
}

/// Number of the planes 1 .. last along an axis at or below x: found one by one.
std::uint32_t planes_below(const protocol::StageLayout& layout, std::uint32_t axis, float x) {
  std::uint32_t cell = 0;
  while (cell + 1U < layout.cells[axis] && x >= pe::grid_of(layout).plane(axis, cell + 1U)) ++cell;
  return cell;
}

TEST(Cells, APointsCellLiesBetweenItsPlanes) {
  const bool holds = rc::check([] {
    GridCase g = random_grid_case();
    for (std::uint32_t a = 0; a < 3; ++a) {
      float& x = g.segment.origin[static_cast<int>(a)];
      const float at = pe::grid_of(g.layout).plane(a, *rc::gen::inRange<std::uint32_t>(0, g.layout.cells[a] + 1U));
      switch (*rc::gen::inRange(0, 6)) {  // on a plane, the floats beside it, outside
        case 0:
          x = at;
          break;
        case 1:
          x = std::nextafter(at, 2.0F);
          break;
        case 2:
          x = std::nextafter(at, -2.0F);
          break;
        case 3:
          x = x * 4.0F - 1.5F;
          break;
        default:
          break;
      }
    }
    const protocol::CellCode code = pe::cell_of(g.layout, g.segment.origin);
    for (std::uint32_t a = 0; a < 3; ++a) {
      RC_ASSERT(protocol::cell_along(code, a) == planes_below(g.layout, a, g.segment.origin[static_cast<int>(a)]));
    }
  });
  EXPECT_TRUE(holds);
}

TEST(Cells, WhatIsNoNumberOrFarAwayHasACell) {
  protocol::StageLayout layout{};
  layout.cells = {7, 1, 1024};
  layout.cell_size = {0.125F, 1.0F, 0x1p-10F};
  const float huge = std::numeric_limits<float>::max();
  const float infinite = std::numeric_limits<float>::infinity();
  const float none = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(pe::cell_of(layout, {huge, huge, huge}), protocol::cell_code(6, 0, 1023));
  EXPECT_EQ(pe::cell_of(layout, {infinite, infinite, infinite}), protocol::cell_code(6, 0, 1023));
  EXPECT_EQ(pe::cell_of(layout, {-huge, -infinite, -infinite}), 0U);
  EXPECT_EQ(pe::cell_of(layout, {none, none, none}), 0U);
}

TEST(Cells, CodesKeepTheirPartsApart) {
  for (const auto& [x, y, z] :
       {std::array{0U, 0U, 0U}, {1023U, 0U, 0U}, {0U, 1023U, 0U}, {0U, 0U, 1023U}, {5U, 6U, 7U}}) {
    const protocol::CellCode code = protocol::cell_code(x, y, z);
    EXPECT_EQ((std::array{protocol::cell_along(code, 0), protocol::cell_along(code, 1), protocol::cell_along(code, 2)}),
              (std::array{x, y, z}));
  }
}

// The map against a list: which cells stop a ray, and the entry of each.
TEST(Cells, TheMapKnowsWhatStandsWhere) {
  const bool holds = rc::check([] {
    const auto cells = *rc::gen::inRange<std::uint32_t>(1, 200);
    const auto seed = *rc::gen::arbitrary<std::uint32_t>();
    std::vector<protocol::CellWord> words(protocol::cell_words(cells));
    std::vector<protocol::CellEntry> entries;
    std::vector<bool> stops;
    std::vector<protocol::CellEntry> expected;
    for (std::uint32_t c = 0; c < cells; ++c) {
      if (c % 32 == 0) words[c / 32].before = static_cast<std::uint32_t>(entries.size());
      stops.push_back(protocol::hash_combine(seed, c) % 3 == 0);
      expected.push_back(c + 1000);
      if (!stops.back()) continue;
      words[c / 32].stops |= 1U << (c % 32);
      entries.push_back(expected.back());
    }
    const pe::CellMap map{words, entries};
    for (std::uint32_t c = 0; c < cells; ++c) {
      RC_ASSERT(map.stops(c) == stops[c]);
      if (!stops[c]) continue;
      RC_ASSERT(map.entry(c) == expected[c]);
    }
  });
  EXPECT_TRUE(holds);
}

// Whatever the tree, the leaf that is found holds the point, and the weights there give its place back.
TEST(TriangleGrid, LeavesHoldTheirPoints) {
  const bool holds = rc::check([] {
    const auto level = *rc::gen::inRange<std::uint32_t>(0, 7);
    const float b1 = static_cast<float>(*rc::gen::inRange(0, 4097)) / 4096.0F;
    const float b2 = (1.0F - b1) * static_cast<float>(*rc::gen::inRange(0, 4097)) / 4096.0F;
    const float slip = static_cast<float>(*rc::gen::inRange(-2, 3)) * 0x1p-23F;  // weights off the triangle by rounding
    protocol::Weights at{1.0F - (b1 + slip) - (b2 + slip), b1 + slip, b2 + slip};
    const protocol::Weights whole = at;
    const std::uint32_t path = protocol::enter_level(at, level);
    const std::uint32_t code = protocol::location_code(path, level);
    RC_ASSERT(protocol::level_of_code(code) == level);
    RC_ASSERT(protocol::path_of_code(code) == path);
    RC_ASSERT(path < protocol::triangles_of_level(level));
    const float most = 4.0F * 0x1p-23F * static_cast<float>(2U << level);
    RC_ASSERT(std::min({at.b0, at.b1, at.b2}) >= -most);
    const protocol::GridTriangle grid = protocol::grid_triangle(path, level);
    const auto weight = [&](std::size_t w) {
      constexpr float unit = 1.0F / (1U << protocol::kMostLevels);
      return unit * (at.b0 * static_cast<float>(grid.corner[0][w]) + at.b1 * static_cast<float>(grid.corner[1][w]) +
                     at.b2 * static_cast<float>(grid.corner[2][w]));
    };
    RC_ASSERT(std::abs(weight(1) - whole.b1) < 2e-6F);
    RC_ASSERT(std::abs(weight(2) - whole.b2) < 2e-6F);
  });
  EXPECT_TRUE(holds);
}

// A tree that is cut in one corner only: points find the small leaf there and the large ones elsewhere.
TEST(TriangleGrid, TreesMayBeCutUnevenly) {
  using protocol::kLeaf;
  const std::array<std::uint32_t, 8> nodes{4,           kLeaf | 1U,  kLeaf | 2U,  kLeaf | 3U,
                                           kLeaf | 10U, kLeaf | 11U, kLeaf | 12U, kLeaf | 13U};
  // Whoever knows of the tree only how deep it may be finds the same leaf.
  const auto leaf_at = [&](float b0, float b1) {
    const protocol::Weights at{b0, b1, 1.0F - b0 - b1};
    protocol::Weights there = at;
    const std::uint32_t leaf = protocol::find_leaf(nodes.data(), 0, there);
    for (const std::uint32_t levels : {2U, 3U, protocol::kMostLevels}) {
      protocol::Weights on_the_way = at;
      EXPECT_EQ(protocol::leaf_on_way(nodes.data(), 0, protocol::way_to_leaf(on_the_way, levels)), leaf) << levels;
    }
    return leaf;
  };
  EXPECT_EQ(leaf_at(0.9F, 0.05F), 10U);
  EXPECT_EQ(leaf_at(0.6F, 0.35F), 11U);
  EXPECT_EQ(leaf_at(0.66F, 0.17F), 13U);
  EXPECT_EQ(leaf_at(0.1F, 0.8F), 1U);
  EXPECT_EQ(leaf_at(0.3F, 0.4F), 3U);
}

}  // namespace
}  // namespace torolux::test
