// SPDX-License-Identifier: MIT
// The Cornell box at the quality presets: path traced radiosities of 8 x 8 cells on every quadrilateral; and the mean
// radiosity of its walls when one block is a mirror.
#include <gtest/gtest.h>

#include <cstdio>

#include "tests/accuracy/runs.hpp"
#include "tests/support/cornell_cells.hpp"
#include "tests/support/cornell_means.hpp"
#include "tests/support/mirror_block.hpp"

namespace torolux::test {
namespace {

std::array<double, 3> cell_mean(const SolvedScene& cornell, const ReferenceQuad& reference, std::size_t quad, int cu,
                                int cv) {
  constexpr int kPoints = 12;
  std::array<double, 3> sum{};
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const int column = i % kPoints;
    const int row = i / kPoints;
    const double u = (cu + (column + 0.5) / kPoints) / kCells;
    const double v = (cv + (row + 0.5) / kPoints) / kCells;
    const PlaceOnQuad place = place_on_quad(cornell.scene, reference, quad, u, v);
    const auto radiance = radiance_at(cornell, static_cast<std::uint32_t>(place.triangle), static_cast<float>(place.b1),
                                      static_cast<float>(place.b2));
    for (std::size_t c = 0; c < 3; ++c) sum[c] += radiance[c] / (kPoints * kPoints);
  }
  return sum;
}

double error_of_cells(const SolvedScene& cornell) {
  const auto reference = cornell_reference();
  return cell_error(
      reference, [&](std::size_t quad, int cu, int cv) { return cell_mean(cornell, reference[quad], quad, cu, cv); });
}

/// The radiosity stage as the command line runs it with --quality. All light comes from the elements, that of shadow
/// rays, too: the radiosity stage holds both.
SolvedScene solve_at(const std::filesystem::path& scene, std::string_view preset) {
  const accuracy::SceneRun run = accuracy::resolve_scene(scene, {});
  RenderCase render_case;
  render_case.quality = accuracy::quality_at(preset_named(preset).value(), run.scene);
  render_case.quality.shadow_rays = false;
  render_case.quality.width = render_case.quality.height = 4;
  render_case.machine = run.resolved.machine;
  SolvedScene solved = solve_scene(run.scene, render_case);
  EXPECT_LT(energy_error(solved.figures.energy), 1e-6);
  return solved;
}

struct PresetBound {
  const char* preset;
  double cells;  ///< RMSE over all cells
  double walls;  ///< greatest error of a wall's mean radiosity
  double block;  ///< and of one of the short block's sides, which are dark
};
// Of `normal` and `fine` the issue's; it asks nothing of `draft` and of the block's sides. Seen: cells 7.1, 1.9, 0.5 %;
// walls 3.4, 0.6, 0.5 %; the block's sides 16, 3.2, 0.9 %: dark as they are, few records come to them. Cells are what
// shots brought; where elements gather, shots have a quarter of the records and may have twice the noise of before (of
// `draft` 4.3 %).
constexpr std::array<PresetBound, 3> kBounds{
    {{"draft", 0.09, 0.05, 0.25}, {"normal", 0.04, 0.02, 0.045}, {"fine", 0.015, 0.02, 0.02}}};

class CornellAccuracy : public testing::TestWithParam<PresetBound> {};

TEST_P(CornellAccuracy, CellsAreThePathTracers) {
  ASSERT_EQ(cornell_reference().size(), 16U);
  const SolvedScene solved = solve_at(source_dir() / "scenes" / "cornell_box", GetParam().preset);
  const double rmse = error_of_cells(solved);
  std::printf("%s: %u elements, %llu records, RMSE of cells %.2f %%\n", GetParam().preset, solved.mesh.elements,
              static_cast<unsigned long long>(solved.figures.radiosity_records), 100 * rmse);
  EXPECT_LT(rmse, GetParam().cells);
}

TEST_P(CornellAccuracy, WallsByAMirrorBlockAreThePathTracers) {
  static const std::vector<GroupLight> traced = traced_mirror_block(4);
  const SolvedScene solved = solve_at(mirror_block_scene(), GetParam().preset);
  for (const WallError& wall : wall_errors(solved, traced)) {
    std::printf("%s, %s: %+.2f %% (noise of the reference %.2f %%)\n", GetParam().preset,
                std::string(wall.wall).c_str(), 100 * wall.error, 100 * wall.noise);
    EXPECT_LT(wall.noise, wall.of_block ? 0.007 : 0.003) << wall.wall;
    EXPECT_NEAR(wall.error, 0, wall.of_block ? GetParam().block : GetParam().walls) << wall.wall;
  }
}

INSTANTIATE_TEST_SUITE_P(Presets, CornellAccuracy, testing::ValuesIn(kBounds),
                         [](const auto& bound) { return std::string(bound.param.preset); });

}  // namespace
}  // namespace torolux::test
