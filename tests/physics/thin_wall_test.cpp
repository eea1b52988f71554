// SPDX-License-Identifier: MIT
// Leaks: a wall of one polygon between a bright and a dark room; closed rooms let nothing out.
#include <gtest/gtest.h>

#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

RenderCase room(const char* name) {
  RenderCase result = native_case(data_dir() / "scenes" / name);
  result.quality.hemicube = 16;
  result.quality.max_shots = 200;
  result.machine.subspaces = {8, 8, 8};
  return result;
}

double escaped_share(const EnergyBalance& energy) {
  return (energy.escaped[0] + energy.cut_off[0] + energy.back_side[0]) / energy.emitted[0];
}

/// The camera stands in the dark room: not one quantum of light arrives there.
TEST(ThinWall, DarkRoomIsBlack) {
  const RenderResult result = run_case(room("thin_wall"));
  float brightest = 0;
  for (const auto& pixel : result.picture.pixels) brightest = std::max({brightest, pixel[0], pixel[1], pixel[2]});
  EXPECT_EQ(brightest, 0.0F);
  EXPECT_GT(result.figures.shots, 0U);
  EXPECT_EQ(escaped_share(result.figures.energy), 0.0);
}

TEST(SubspaceWalls, NothingEscapesFromAClosedRoom) {
  const RenderResult result = run_case(room("subspace_walls"));
  EXPECT_EQ(escaped_share(result.figures.energy), 0.0);
  float brightest = 0;
  for (const auto& pixel : result.picture.pixels) brightest = std::max(brightest, pixel[0]);
  EXPECT_GT(brightest, 0.0F);
}

}  // namespace
}  // namespace torolux::test
