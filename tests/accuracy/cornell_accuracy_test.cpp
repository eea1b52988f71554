// SPDX-License-Identifier: MIT
// The Cornell box at finer and finer settings against the path traced radiosity of 8 x 8 cells on every quadrilateral.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>

#include "tests/support/cornell_cells.hpp"
#include "tests/support/cornell_means.hpp"

namespace torolux::test {
namespace {

std::array<double, 3> cell_mean(const CornellSolution& cornell, const ReferenceQuad& reference, std::size_t quad,
                                int cu, int cv) {
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

double error_of_cells(const CornellSolution& cornell) {
  const auto reference = cornell_reference();
  return cell_error(
      reference, [&](std::size_t quad, int cu, int cv) { return cell_mean(cornell, reference[quad], quad, cu, cv); });
}

/// Of the worst surface and channel, relative.
double worst_mean_error(const CornellSolution& cornell) {
  const auto means = mean_radiance(cornell);
  double worst = 0;
  for (const CornellMean& mean : kCornellMeans) {
    for (std::size_t c = 0; c < 3; ++c) {
      worst = std::fmax(worst, std::fabs(means[mean.quad][c] / mean.radiance[c] - 1));
    }
  }
  return worst;
}

struct Setting {
  double patches, elements;
  std::uint32_t hemicube, shot_points;
};

TEST(CornellAccuracy, FinerSettingsComeCloser) {
  ASSERT_EQ(cornell_reference().size(), 16U);
  std::printf("patches elements hemicube points |    records   shots | worst mean   RMSE of cells\n");
  double mean_error = 1;
  double rmse = 1;
  for (const Setting& setting :
       {Setting{200, 100, 8, 1}, Setting{200, 50, 16, 2}, Setting{100, 50, 16, 2}, Setting{100, 25, 32, 2}}) {
    RenderCase cornell = native_case(source_dir() / "scenes" / "cornell_box");
    cornell.quality.patch_length = setting.patches;
    cornell.quality.element_length = setting.elements;
    cornell.quality.hemicube = setting.hemicube;
    cornell.quality.shot_points = setting.shot_points;
    cornell.quality.unshot = 0.001;
    cornell.quality.width = cornell.quality.height = 4;
    cornell.machine.subspaces = {4, 4, 4};
    const CornellSolution solution = solve_cornell(cornell);
    mean_error = worst_mean_error(solution);
    rmse = error_of_cells(solution);
    std::printf("%7.0f %8.0f %8u %6u | %10llu %7llu | %8.2f %%  %12.2f %%\n", setting.patches, setting.elements,
                setting.hemicube, setting.shot_points,
                static_cast<unsigned long long>(solution.figures.radiosity_records),
                static_cast<unsigned long long>(solution.figures.shots), 100 * mean_error, 100 * rmse);
    std::fflush(stdout);
    EXPECT_LT(energy_error(solution.figures.energy), 1e-5);
  }
  // A trial on one computer reached an RMSE of 2.8 % with 43 million records and 1.5 % with 262 million
  // (references.md); here it is 79 million. Means average most of that out.
  EXPECT_LT(rmse, 0.025);
  EXPECT_LT(mean_error, 0.015);
}

}  // namespace
}  // namespace torolux::test
