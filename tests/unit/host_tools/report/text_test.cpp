// SPDX-License-Identifier: MIT
// Proves: numbers read as people write them.
#include "host_tools/report/text.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace torolux {
namespace {

TEST(Text, Numbers) {
  EXPECT_EQ(grouped(0), "0");
  EXPECT_EQ(grouped(999), "999");
  EXPECT_EQ(grouped(1000), "1 000");
  EXPECT_EQ(grouped(1234567), "1 234 567");
  EXPECT_EQ(fixed(1.005, 1), "1.0");
  EXPECT_EQ(significant(0.00012345, 3), "0.000123");
  EXPECT_EQ(percent(0.1234), "12.3 %");
  EXPECT_EQ(percent(1, 0), "100 %");
  EXPECT_EQ(fixed(std::numeric_limits<double>::max(), 1).size(), 311U);
}

TEST(Text, Bytes) {
  EXPECT_EQ(bytes_text(12), "12 bytes");
  EXPECT_EQ(bytes_text(512 * 1024), "512 KiB");
  EXPECT_EQ(bytes_text(1536 * 1024), "1.5 MiB");
  EXPECT_EQ(bytes_text(64ULL << 20U), "64 MiB");
}

TEST(Text, Durations) {
  EXPECT_EQ(duration(0.44), "0.4 s");
  EXPECT_EQ(duration(9.96), "10 s");
  EXPECT_EQ(duration(59.7), "1 min 00 s");
  EXPECT_EQ(duration(185), "3 min 05 s");
  EXPECT_EQ(duration(7620), "2 h 07 min");
  EXPECT_EQ(duration(std::numeric_limits<double>::quiet_NaN()), "?");
}

TEST(Text, Hexadecimal) {
  EXPECT_EQ(hexadecimal(0xABCD), "0x000000000000abcd");
  EXPECT_EQ(hexadecimal(0xFEDC'BA98'7654'3210U), "0xfedcba9876543210");
}

TEST(Text, Padding) {
  EXPECT_EQ(right("ab", 4), "  ab");
  EXPECT_EQ(left("ab", 4), "ab  ");
  EXPECT_EQ(right("abcd", 2), "abcd");
}

}  // namespace
}  // namespace torolux
