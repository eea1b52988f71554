// SPDX-License-Identifier: MIT
// Proves: each sample of a picture has a place of its own, and numbers drawn by these places keep apart over pixels,
// and over squares of them.
#include "firmware/protocol/picture_order.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <set>
#include <vector>

#include "firmware/protocol/stratified.hpp"

namespace torolux::protocol {
namespace {

constexpr std::uint32_t kKey = 20261130;

/// Of all samples of the square of pixels that begins here.
std::vector<StratifiedPair> pairs_of(std::uint32_t column, std::uint32_t row, std::uint32_t edge,
                                     std::uint32_t samples) {
  std::vector<StratifiedPair> pairs;
  for (std::uint32_t i = 0; i < edge * edge; ++i) {
    for (std::uint32_t sample = 0; sample < samples; ++sample)
      pairs.push_back(stratified_pair(place_in_picture(column + i % edge, row + i / edge, sample, samples), kKey));
  }
  return pairs;
}

/// The most of them in one cell of any grid of as many equal boxes over the unit square.
std::size_t most_in_a_cell(const std::vector<StratifiedPair>& pairs) {
  const int bits = std::countr_zero(pairs.size());
  std::size_t most = 0;
  for (int across = 0; across <= bits; ++across) {
    std::multiset<std::uint64_t> cells;
    for (const StratifiedPair& pair : pairs) {
      const std::uint64_t column = std::uint64_t{pair.x} >> (32 - across);
      const std::uint64_t row = std::uint64_t{pair.y} >> (32 - (bits - across));
      cells.insert(row << 32U | column);
    }
    for (const std::uint64_t cell : cells) most = std::max(most, cells.count(cell));
  }
  return most;
}

TEST(PictureOrder, EverySampleHasAPlaceOfItsOwn) {
  for (const std::uint32_t samples : {1U, 2U, 5U, 8U}) {
    std::set<std::uint32_t> places;
    for (std::uint32_t row = 0; row < 19; ++row) {
      for (std::uint32_t column = 0; column < 33; ++column) {
        for (std::uint32_t sample = 0; sample < samples; ++sample)
          places.insert(place_in_picture(column, row, sample, samples));
      }
    }
    EXPECT_EQ(places.size(), 19U * 33U * samples) << samples << " samples";
  }
}

TEST(PictureOrder, TheLastPixelOfTheLargestPictureIsTheLastPlace) {
  EXPECT_EQ(place_in_picture(65535, 65535, 0, 1), 0xFFFF'FFFFU);
}

TEST(PictureOrder, NumbersKeepApartOverAPixelsSamples) {
  for (std::uint32_t column = 0; column < 16; ++column)
    EXPECT_EQ(most_in_a_cell(pairs_of(column, 7, 1, 32)), 1U) << "column " << column;
}

TEST(PictureOrder, NumbersKeepApartOverSquaresOfPixels) {
  EXPECT_EQ(most_in_a_cell(pairs_of(6, 10, 2, 8)), 1U);
  EXPECT_EQ(most_in_a_cell(pairs_of(4, 12, 4, 8)), 1U);
  EXPECT_EQ(most_in_a_cell(pairs_of(8, 0, 8, 4)), 1U);
}

}  // namespace
}  // namespace torolux::protocol
