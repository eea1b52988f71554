// SPDX-License-Identifier: MIT
// Proves: CIE coordinates of colours that are published or follow from their definition, and the way back.
#include "host_tools/picture/lightness.hpp"

#include <gtest/gtest.h>

namespace torolux {
namespace {

std::array<double, 3> lab(const std::array<double, 3>& linear) {
  return lab_of_xyz(relative_xyz(linear));
}

TEST(Lightness, OfBlackMiddleGreyAndWhite) {
  EXPECT_NEAR(lab({0, 0, 0})[0], 0, 1e-12);
  EXPECT_NEAR(lab({0.184187, 0.184187, 0.184187})[0], 50, 1e-4);  // ((50 + 16) / 116)^3
  EXPECT_NEAR(lab({1, 1, 1})[0], 100, 1e-12);
  EXPECT_NEAR(lab({0.001, 0.001, 0.001})[0], 0.9033, 1e-4);  // 903.3 Y near black
}

// L* a* b* of the primaries of sRGB, as colour tables have them.
TEST(Lightness, OfThePrimaries) {
  const std::array<double, 3> red = lab({1, 0, 0});
  EXPECT_NEAR(red[0], 53.24, 0.02);
  EXPECT_NEAR(red[1], 80.09, 0.02);
  EXPECT_NEAR(red[2], 67.20, 0.02);
  const std::array<double, 3> green = lab({0, 1, 0});
  EXPECT_NEAR(green[0], 87.73, 0.02);
  EXPECT_NEAR(green[1], -86.18, 0.02);
  EXPECT_NEAR(green[2], 83.18, 0.02);
}

TEST(Lightness, TheWayBack) {
  const std::array<double, 3> back = linear_of_xyz(relative_xyz({0.1, 0.7, 0.3}));
  EXPECT_NEAR(back[0], 0.1, 1e-12);
  EXPECT_NEAR(back[1], 0.7, 1e-12);
  EXPECT_NEAR(back[2], 0.3, 1e-12);
}

}  // namespace
}  // namespace torolux
