// SPDX-License-Identifier: MIT
// Proves: the records of a shot have keys of their own, whatever their point and pixel.
#include <gtest/gtest.h>

#include <set>

#include "firmware/protocol/record_key.hpp"

namespace torolux::test {
namespace {

using protocol::hash_combine;
using protocol::pixel_key;
using protocol::point_key;
using protocol::record_key;

TEST(RecordKey, IsOfOneRecordOfItsShot) {
  constexpr std::uint32_t kPoints = 64, kPixels = 192;
  std::size_t doubles = 0;
  for (std::uint32_t shot = 1; shot <= 20; ++shot) {
    std::set<std::uint32_t> keys;
    for (std::uint32_t point = 0; point < kPoints; ++point) {
      for (std::uint32_t pixel = 0; pixel < kPixels; ++pixel)
        keys.insert(record_key(point_key(hash_combine(7, shot), point), pixel_key(hash_combine(7, shot), pixel)));
    }
    doubles += kPoints * kPixels - keys.size();
  }
  // By chance: 20 * 12,288^2 / 2 / 2^32 = 0.35 in all; five or more once in some 30,000 times.
  EXPECT_LT(doubles, 5U);
}

}  // namespace
}  // namespace torolux::test
