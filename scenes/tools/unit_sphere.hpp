// SPDX-License-Identifier: MIT
// A sphere of triangles with normals, for the generators of the scenes.
#pragma once

#include <algorithm>

#include "scenes/tools/obj_writer.hpp"

namespace scene_tools {

using Triangle = std::array<Point, 3>;

inline Point unit(const Point& p) {
  const double length = std::hypot(p[0], p[1], p[2]);
  return {p[0] / length, p[1] / length, p[2] / length};
}

/// An octahedron whose triangles are cut into four, `levels` times.
inline std::vector<Triangle> unit_sphere(int levels) {
  const auto middle = [](const Point& a, const Point& b) { return unit({a[0] + b[0], a[1] + b[1], a[2] + b[2]}); };
  std::vector<Triangle> triangles;
  for (const double x : {-1.0, 1.0})
    for (const double y : {-1.0, 1.0})
      for (const double z : {-1.0, 1.0}) {
        Triangle t{{{x, 0, 0}, {0, y, 0}, {0, 0, z}}};
        if (x * y * z < 0) std::swap(t[1], t[2]);
        triangles.push_back(t);
      }
  for (int level = 0; level < levels; ++level) {
    std::vector<Triangle> finer;
    for (const auto& [a, b, c] : triangles) {
      const Point ab = middle(a, b);
      const Point bc = middle(b, c);
      const Point ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  return triangles;
}

inline void sphere(ObjWriter& writer, const Point& centre, double radius, int levels) {
  std::map<Point, int> normals;
  for (const Triangle& triangle : unit_sphere(levels)) {
    std::vector<int> positions;
    std::vector<int> used;
    for (const Point& n : triangle) {
      const auto [entry, fresh] = normals.emplace(n, 0);
      if (fresh) entry->second = writer.normal(n);
      used.push_back(entry->second);
      positions.push_back(
          writer.position({centre[0] + radius * n[0], centre[1] + radius * n[1], centre[2] + radius * n[2]}));
    }
    writer.face(positions, used);
  }
}

}  // namespace scene_tools
