// SPDX-License-Identifier: MIT
// The Cornell box against an independent path tracer: mean radiance of its surfaces.
#include <gtest/gtest.h>

#include "tests/support/cornell_means.hpp"

namespace torolux::test {
namespace {

TEST(CornellBox, MeanRadianceIsThatOfThePathTracer) {
  RenderCase cornell = native_case(source_dir() / "scenes" / "cornell_box");
  cornell.quality.patch_length = 100;
  cornell.quality.element_length = 50;
  cornell.quality.unshot = 0.003;  // what is not shot is missing
  cornell.quality.width = cornell.quality.height = 4;
  cornell.machine.subspaces = {4, 4, 4};
  const SolvedScene solution = solve_scene(cornell);
  const auto means = mean_radiance(solution);

  for (const CornellMean& reference : kCornellMeans) {
    for (std::size_t c = 0; c < 3; ++c) {
      // 5 %: the bound at this size; 3 % would need elements that hold shadow edges (references.md).
      EXPECT_NEAR(means.at(reference.quad)[c], reference.radiance[c], 0.05 * reference.radiance[c])
          << reference.name << ", channel " << c;
    }
  }
  EXPECT_LT(energy_error(solution.figures.energy), 1e-5);
  EXPECT_EQ(solution.figures.credits_home, solution.figures.credits_total);
}

}  // namespace
}  // namespace torolux::test
