// SPDX-License-Identifier: MIT
// Proves: the forms of --follow are told apart, and what is neither is refused with both.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "emulator/errors.hpp"
#include "host_tools/cli/parse_values.hpp"

namespace torolux::test {
namespace {

TEST(FollowTarget, IsAPixelOrAPointOfAShot) {
  const auto pixel = std::get<FollowedPixel>(parse_follow("120,64"));
  EXPECT_EQ(pixel.column, 120U);
  EXPECT_EQ(pixel.row, 64U);
  EXPECT_EQ(pixel.sample, 0U);
  EXPECT_EQ(std::get<FollowedPixel>(parse_follow("0,1:15")).sample, 15U);
  const auto shot = std::get<FollowedShot>(parse_follow("17:3"));
  EXPECT_EQ(shot.shot, 17U);
  EXPECT_EQ(shot.point, 3U);
  EXPECT_EQ(shot.direction, 0U);
  EXPECT_EQ(std::get<FollowedShot>(parse_follow("0:0:191")).direction, 191U);
}

TEST(FollowTarget, IsRefusedWithBothForms) {
  for (const char* text : {"", "1", ",", ":", "1,", ",1", "1:", "1,2,3", "1,2:3:4", "1:2:3:4", "1, 2", "-1,2", "a:b",
                           "1,4294967296", "1:2,3"}) {
    try {
      parse_follow(text);
      ADD_FAILURE() << "'" << text << "' was taken";
    } catch (const UsageError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("X,Y:SAMPLE"));
      EXPECT_THAT(error.what(), testing::HasSubstr("SHOT:POINT:DIRECTION"));
    }
  }
}

}  // namespace
}  // namespace torolux::test
