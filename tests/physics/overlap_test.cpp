// SPDX-License-Identifier: MIT
// A lamp in the plane of the ceiling lights a closed room as one that hangs a hair lower, and no light gets out.
#include <gtest/gtest.h>

#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

RenderResult lit_room(const char* file) {
  RenderCase result = native_case(data_dir() / "overlaps" / "lamp_in_ceiling" / file);
  result.quality.hemicube = 16;
  result.quality.max_shots = 0;
  result.quality.width = result.quality.height = 48;
  result.machine.subspaces = {4, 4, 4};
  return run_case(result);
}

/// Of the floor's part of the picture, which sees no lamp: what is noise there is noise of radiosity.
double mean_below(const Picture& picture) {
  double sum = 0;
  const std::size_t half = picture.pixels.size() / 2;
  for (std::size_t i = half; i < picture.pixels.size(); ++i) sum += picture.pixels[i][0];
  return sum / static_cast<double>(half);
}

TEST(Overlaps, ALampInTheCeilingIsALampUnderIt) {
  const RenderResult flush = lit_room("scene.toml");
  const RenderResult moved = lit_room("moved.toml");
  const auto& energy = flush.figures.energy;
  EXPECT_EQ(energy.escaped[0] + energy.back_side[0], 0.0);
  // The issue asks for 1 %. Measured: 0.5 %; where nothing is cut, 24 %.
  EXPECT_NEAR(mean_below(flush.picture) / mean_below(moved.picture), 1, 0.01);
  // By squares of 8 x 8 pixels, so that what is left is no grain.
  for (std::size_t y = 24; y < 48; y += 8) {
    for (std::size_t x = 0; x < 48; x += 8) {
      double sum = 0;
      double reference = 0;
      for (std::size_t i = 0; i < 64; ++i) {
        const std::size_t pixel = (y + i / 8) * 48 + x + i % 8;
        sum += flush.picture.pixels[pixel][0];
        reference += moved.picture.pixels[pixel][0];
      }
      // Elements are cut otherwise, so their noise is another one: the squares were seen to differ by up to 3.2 %.
      EXPECT_NEAR(sum / reference, 1, 0.05) << x << ", " << y;
    }
  }
}

}  // namespace
}  // namespace torolux::test
