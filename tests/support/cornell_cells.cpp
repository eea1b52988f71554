// SPDX-License-Identifier: MIT
// Two CSV files become quadrilaterals with radiances by cell; the error is the relative RMSE over cells and channels,
// weighted by area, without the lamp.
#include "tests/support/cornell_cells.hpp"

#include <cmath>
#include <fstream>
#include <map>
#include <numbers>
#include <sstream>

#include "host_tools/scene/vec.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> result;
  std::istringstream stream(line);
  for (std::string field; std::getline(stream, field, ',');) result.push_back(field);
  return result;
}

/// Weights of corners 1 and 2 of the triangle at the point, projected on its plane.
std::array<double, 2> weights_at(const Scene& scene, const SceneTriangle& triangle, const Vec3d& point) {
  const Vec3d& corner = scene.positions[triangle.position[0]];
  const Vec3d a = vec::subtract(scene.positions[triangle.position[1]], corner);
  const Vec3d b = vec::subtract(scene.positions[triangle.position[2]], corner);
  const Vec3d p = vec::subtract(point, corner);
  const double aa = vec::dot(a, a), ab = vec::dot(a, b), bb = vec::dot(b, b);
  const double pa = vec::dot(p, a), pb = vec::dot(p, b);
  const double determinant = aa * bb - ab * ab;
  return {(pa * bb - pb * ab) / determinant, (pb * aa - pa * ab) / determinant};
}

double triangle_area(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return vec::length(vec::cross(vec::subtract(b, a), vec::subtract(c, a))) / 2;
}

}  // namespace

Vec3d ReferenceQuad::point(double u, double v) const {
  Vec3d result{};
  const std::array<double, 4> weight{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
  for (std::size_t i = 0; i < 4; ++i) result = vec::add(result, vec::scale(corner[i], weight[i]));
  return result;
}

double ReferenceQuad::area() const {
  return triangle_area(corner[0], corner[1], corner[2]) + triangle_area(corner[0], corner[2], corner[3]);
}

std::vector<ReferenceQuad> cornell_reference() {
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

PlaceOnQuad place_on_quad(const Scene& scene, const ReferenceQuad& quad, std::size_t number, double u, double v) {
  const Vec3d point = quad.point(u, v);
  const auto [b1, b2] = weights_at(scene, scene.triangles[2 * number], point);
  if (b1 >= 0 && b2 >= 0 && b1 + b2 <= 1) return {2 * number, b1, b2};
  // The second triangle takes what rounding leaves on their common edge.
  const auto second = weights_at(scene, scene.triangles[2 * number + 1], point);
  return {2 * number + 1, second[0], second[1]};
}

double cell_error(const std::vector<ReferenceQuad>& reference, const CellRadiance& radiance) {
  double error = 0;
  double square = 0;
  for (std::size_t q = 0; q < reference.size(); ++q) {
    if (q == kCornellLight) continue;
    const double area = reference[q].area();
    for (int cell = 0; cell < kCells * kCells; ++cell) {
      const int cu = cell % kCells;
      const int cv = cell / kCells;
      const auto is = radiance(q, cu, cv);
      const auto& should = reference[q].radiance[static_cast<std::size_t>(cv)][static_cast<std::size_t>(cu)];
      for (std::size_t c = 0; c < 3; ++c) {
        error += area * (is[c] - should[c]) * (is[c] - should[c]);
        square += area * should[c] * should[c];
      }
    }
  }
  return std::sqrt(error / square);
}

}  // namespace torolux::test
