// SPDX-License-Identifier: MIT
// Proves: stratified pairs lie one in each cell of every grid, for any key, and a triple's third number keeps apart
// from both others; different keys have nothing to do with each other, and the order is shuffled.
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <set>
#include <vector>

#include "firmware/protocol/stratified.hpp"

namespace torolux::protocol {
namespace {

TEST(StratifiedPair, OneInEachCellOfEveryGrid) {
  for (const std::uint32_t key : {0U, 1U, 77U, 0xFFFF'FFFFU, 0x1234'5678U}) {
    for (std::uint32_t m = 0; m <= 10; ++m) {
      const std::uint32_t count = 1U << m;
      for (const std::uint32_t first : {0U, count, 6U * count}) {
        std::vector<StratifiedPair> pairs;
        for (std::uint32_t s = 0; s < count; ++s) pairs.push_back(stratified_pair(first + s, key));
        for (std::uint32_t across = 0; across <= m; ++across) {  // 2^across x 2^(m - across) cells
          std::set<std::uint64_t> cells;
          for (const StratifiedPair& p : pairs) {
            cells.insert((std::uint64_t{p.x} << across >> 32U) << 32U | (std::uint64_t{p.y} << (m - across) >> 32U));
          }
          ASSERT_EQ(cells.size(), count) << "key " << key << ", first " << first << ", " << across << " of " << m;
        }
      }
    }
  }
}

// At most two: the third number's pairs are of a (1,2)-sequence.
TEST(StratifiedTriple, ThirdNumberKeepsApartFromBothOthers) {
  for (const std::uint32_t key : {0U, 1U, 0xFFFF'FFFFU, 0x1234'5678U}) {
    for (std::uint32_t m = 1; m <= 10; ++m) {
      const std::uint32_t count = 1U << m;
      std::set<std::uint32_t> parts;
      std::vector<StratifiedTriple> triples;
      for (std::uint32_t s = 0; s < count; ++s) {
        triples.push_back(stratified_triple(3U * count + s, key));
        parts.insert(triples.back().z >> (32U - m));
        ASSERT_EQ(triples.back().y, stratified_pair(3U * count + s, key).y);
      }
      ASSERT_EQ(parts.size(), count) << "key " << key << ", " << count << " samples";
      for (std::uint32_t across = 0; across <= m; ++across) {
        for (const auto other : {&StratifiedTriple::x, &StratifiedTriple::y}) {
          std::map<std::uint64_t, int> in_cell;
          for (const StratifiedTriple& t : triples) {
            const int many = ++in_cell[(std::uint64_t{t.z} << across >> 32U) << 32U |
                                       (std::uint64_t{t.*other} << (m - across) >> 32U)];
            ASSERT_LE(many, 2) << "key " << key << ", " << count << " samples, " << across << " of " << m;
          }
        }
      }
    }
  }
}

// Mean products of what is independent and uniform: 1/4. Deviation of a product 0.22, so 0.01 is 4.5 of 10,000's.
TEST(StratifiedPair, DifferentKeysHaveNothingToDoWithEachOther) {
  double own = 0;
  double other = 0;
  for (std::uint32_t key = 0; key < 10'000; ++key) {
    const StratifiedPair a = stratified_pair(key % 8, key);
    const StratifiedPair b = stratified_pair(key % 8, key + 1);
    own += std::ldexp(static_cast<double>(a.x) * a.y, -64);
    other += std::ldexp(static_cast<double>(a.x) * b.x, -64);
  }
  EXPECT_NEAR(own / 10'000, 0.25, 0.01);
  EXPECT_NEAR(other / 10'000, 0.25, 0.01);
}

// The camera's samples have an order, too: it must not always put the same light with the same part of a pixel.
TEST(StratifiedPair, OrderIsShuffled) {
  int same = 0;
  for (std::uint32_t key = 0; key < 1000; ++key) {
    same += (stratified_pair(0, key).x ^ stratified_pair(2, key).x) >> 31U == 0 ? 1 : 0;
  }
  EXPECT_NEAR(same, 500, 80) << "five deviations";
}

}  // namespace
}  // namespace torolux::protocol
