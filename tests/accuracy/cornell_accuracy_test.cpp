// SPDX-License-Identifier: MIT
// The Cornell box at finer and finer settings against the path traced radiosity of 8 x 8 cells on every quadrilateral.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/support/cornell_means.hpp"

namespace torolux::test {
namespace {

constexpr int kCells = 8;

struct ReferenceQuad {
  std::array<Vec3d, 4> corner;
  std::array<std::array<std::array<double, 3>, kCells>, kCells> radiance{};  ///< by cv, cu
};

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) result.push_back(field);
  return result;
}

/// Quadrilaterals in the order of the scene file, their cells as path traced.
std::vector<ReferenceQuad> reference() {
  std::vector<ReferenceQuad> quads;
  std::map<std::string, std::size_t> number;
  std::ifstream corners(data_dir() / "cornell_quads.csv");
  for (std::string line; std::getline(corners, line);) {
    const auto field = fields(line);
    if (line.starts_with('#') || field.size() != 13) continue;
    number[field[0]] = quads.size();
    ReferenceQuad& quad = quads.emplace_back();
    for (std::size_t i = 0; i < 12; ++i) quad.corner[i / 3][i % 3] = std::stod(field[1 + i]);
  }
  std::ifstream cells(data_dir() / "cornell_reference_cells.csv");
  for (std::string line; std::getline(cells, line);) {
    const auto field = fields(line);
    if (line.starts_with('#') || field.size() != 7 || !number.contains(field[0])) continue;
    auto& cell = quads[number[field[0]]].radiance.at(std::stoul(field[2])).at(std::stoul(field[1]));
    for (std::size_t c = 0; c < 3; ++c) cell[c] = std::stod(field[3 + c]) / std::numbers::pi;
  }
  return quads;
}

Vec3d point_of(const ReferenceQuad& quad, double u, double v) {
  Vec3d point{};
  const std::array<double, 4> weight{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
  for (std::size_t i = 0; i < 4; ++i) point = vec::add(point, vec::scale(quad.corner[i], weight[i]));
  return point;
}

/// Weights of corners 1 and 2 of the triangle at the point, projected on its plane.
std::array<double, 2> weights_at(const Scene& scene, const MeshTriangle& triangle, const Vec3d& point) {
  const Vec3d& corner = scene.positions[triangle.position[0]];
  const Vec3d a = vec::subtract(scene.positions[triangle.position[1]], corner);
  const Vec3d b = vec::subtract(scene.positions[triangle.position[2]], corner);
  const Vec3d p = vec::subtract(point, corner);
  const double aa = vec::dot(a, a), ab = vec::dot(a, b), bb = vec::dot(b, b);
  const double pa = vec::dot(p, a), pb = vec::dot(p, b);
  const double determinant = aa * bb - ab * ab;
  return {(pa * bb - pb * ab) / determinant, (pb * aa - pa * ab) / determinant};
}

std::array<double, 3> radiance_at(const CornellSolution& cornell, std::size_t quad, const Vec3d& point) {
  for (const std::size_t t : {2 * quad, 2 * quad + 1}) {
    const MeshTriangle& triangle = cornell.mesh.triangles[t];
    const auto [b1, b2] = weights_at(cornell.scene, triangle, point);
    // The second triangle takes what rounding leaves on their common edge.
    if (t == 2 * quad && (b1 < 0 || b2 < 0 || b1 + b2 > 1)) continue;
    const std::uint32_t path =
        protocol::path_of_point(static_cast<float>(b1), static_cast<float>(b2), triangle.element_level);
    return element_radiance(cornell, triangle, path);
  }
  return {};
}

std::array<double, 3> cell_mean(const CornellSolution& cornell, const ReferenceQuad& reference, std::size_t quad,
                                int cu, int cv) {
  constexpr int kPoints = 12;
  std::array<double, 3> sum{};
  for (int i = 0; i < kPoints * kPoints; ++i) {
    const double u = (cu + (i % kPoints + 0.5) / kPoints) / kCells;
    const double v = (cv + (i / kPoints + 0.5) / kPoints) / kCells;
    const auto radiance = radiance_at(cornell, quad, point_of(reference, u, v));
    for (std::size_t c = 0; c < 3; ++c) sum[c] += radiance[c] / (kPoints * kPoints);
  }
  return sum;
}

/// Area-weighted RMSE of all cells but the light's, relative to their area-weighted root mean square.
double cell_error(const CornellSolution& cornell) {
  const auto quads = reference();
  double error = 0;
  double square = 0;
  for (std::size_t q = 0; q < quads.size(); ++q) {
    if (q == 1) continue;  // the light
    const double area = cornell.mesh.triangles[2 * q].area + cornell.mesh.triangles[2 * q + 1].area;
    for (int cell = 0; cell < kCells * kCells; ++cell) {
      const int cu = cell % kCells;
      const int cv = cell / kCells;
      const auto is = cell_mean(cornell, quads[q], q, cu, cv);
      const auto& should = quads[q].radiance[static_cast<std::size_t>(cv)][static_cast<std::size_t>(cu)];
      for (std::size_t c = 0; c < 3; ++c) {
        error += area * (is[c] - should[c]) * (is[c] - should[c]);
        square += area * should[c] * should[c];
      }
    }
  }
  return std::sqrt(error / square);
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
  ASSERT_EQ(reference().size(), 16U);
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
    rmse = cell_error(solution);
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
