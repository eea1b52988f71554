// SPDX-License-Identifier: MIT
// Shapes in, OBJ statements out: what the generators of the scenes share. Fronts face outwards.
#pragma once

#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <string>
#include <vector>

namespace scene_tools {

using Point = std::array<double, 3>;

/// Writes to standard output. Lengths in scene units.
class ObjWriter {
 public:
  explicit ObjWriter(const std::string& library) { std::printf("mtllib %s\n", library.c_str()); }

  void material(const std::string& name) {
    if (name != material_) std::printf("usemtl %s\n", name.c_str());
    material_ = name;
  }
  void group(const std::string& name) { std::printf("g %s\n", name.c_str()); }

  /// Equal positions get one index.
  int position(const Point& p) {
    std::array<char, 96> text{};
    std::snprintf(text.data(), text.size(), "%.6g %.6g %.6g", p[0] + 0.0, p[1] + 0.0, p[2] + 0.0);
    const auto [entry, fresh] = positions_.emplace(text.data(), static_cast<int>(positions_.size()) + 1);
    if (fresh) std::printf("v %s\n", text.data());
    return entry->second;
  }
  int normal(const Point& n) {
    std::printf("vn %.6g %.6g %.6g\n", n[0], n[1], n[2]);
    return ++normals_;
  }
  void face(const std::vector<int>& positions, const std::vector<int>& normals = {}) {
    std::printf("f");
    for (std::size_t i = 0; i < positions.size(); ++i) {
      std::printf(" %d", positions[i]);
      if (!normals.empty()) std::printf("//%d", normals[i]);
    }
    std::printf("\n");
  }
  void polygon(const std::vector<Point>& corners) {
    std::vector<int> numbers;
    numbers.reserve(corners.size());
    for (const Point& corner : corners) numbers.push_back(position(corner));
    face(numbers);
  }

  /// With a texture point (u, v) for each corner.
  void polygon(const std::vector<Point>& corners, const std::vector<std::array<double, 2>>& texture_points) {
    std::vector<int> numbers;
    numbers.reserve(corners.size());
    for (const Point& corner : corners) numbers.push_back(position(corner));
    for (const auto& [u, v] : texture_points) std::printf("vt %.6g %.6g\n", u, v);
    std::printf("f");
    for (const int number : numbers) std::printf(" %d/%d", number, ++texture_points_);
    std::printf("\n");
  }
  /// A parallelogram from `corner` along two edges; the front is where they run counter-clockwise. The texture repeats
  /// `across` times along the first and `up` times along the second.
  void textured(const Point& corner, const Point& first, const Point& second, double across, double up) {
    const auto at = [&](double a, double b) -> Point {
      return {corner[0] + a * first[0] + b * second[0], corner[1] + a * first[1] + b * second[1],
              corner[2] + a * first[2] + b * second[2]};
    };
    polygon({at(0, 0), at(1, 0), at(1, 1), at(0, 1)}, {{0, 0}, {across, 0}, {across, up}, {0, up}});
  }

  /// A box turned by `degrees` about the vertical axis through `pivot`.
  void box(const Point& low, const Point& high, double degrees = 0, const Point& pivot = {0, 0, 0}) {
    const double c = std::cos(degrees * std::numbers::pi / 180);
    const double s = std::sin(degrees * std::numbers::pi / 180);
    std::array<Point, 8> corner{};
    for (std::size_t i = 0; i < 8; ++i) {
      const Point p{(i & 1U) != 0 ? high[0] : low[0], (i & 2U) != 0 ? high[1] : low[1],
                    (i & 4U) != 0 ? high[2] : low[2]};
      const double x = p[0] - pivot[0];
      const double z = p[2] - pivot[2];
      corner[i] = {pivot[0] + c * x + s * z, p[1], pivot[2] - s * x + c * z};
    }
    constexpr std::array<std::array<std::size_t, 4>, 6> faces{
        {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
    for (const auto& f : faces) polygon({corner[f[0]], corner[f[1]], corner[f[2]], corner[f[3]]});
  }

  /// A profile of (radius, height) turned about the vertical axis through `base`; from the lower end outside to
  /// wherever it leads. Radius 0 at an end closes it in a point.
  void lathe(const Point& base, const std::vector<std::array<double, 2>>& profile, int segments) {
    const auto at = [&](std::size_t ring, int segment) -> Point {
      const double angle = 2 * std::numbers::pi * (segment % segments) / segments;
      const auto& [radius, height] = profile[ring];
      return {base[0] + radius * std::cos(angle), base[1] + height, base[2] + radius * std::sin(angle)};
    };
    for (std::size_t ring = 0; ring + 1 < profile.size(); ++ring) {
      for (int s = 0; s < segments; ++s) {
        std::vector<Point> corners{at(ring, s), at(ring + 1, s)};
        if (profile[ring + 1][0] > 0) corners.push_back(at(ring + 1, s + 1));
        if (profile[ring][0] > 0) corners.push_back(at(ring, s + 1));
        polygon(corners);
      }
    }
  }

 private:
  std::string material_;
  std::map<std::string, int> positions_;
  int normals_ = 0;
  int texture_points_ = 0;
};

}  // namespace scene_tools
