// SPDX-License-Identifier: MIT
// Tried in turn: the axes of space, the shapes' normals, and products of edges with each other and with normals. The
// first that parts the shapes decides.
#include "host_tools/mesh/separation.hpp"

#include <algorithm>
#include <array>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

struct Shape {
  std::span<const Vec3d> points;
  std::array<Vec3d, 3> edges{};
  std::size_t edge_count = 0;
  Vec3d normal{0, 0, 0};
};

Shape shape_of(std::span<const Vec3d> points) {
  Shape shape{.points = points};
  shape.edge_count = points.size() == 3 ? 3 : 1;
  for (std::size_t i = 0; i < shape.edge_count; ++i) {
    shape.edges[i] = vec::subtract(points[(i + 1) % points.size()], points[i]);
  }
  if (points.size() == 3) shape.normal = vec::cross(shape.edges[0], shape.edges[1]);
  return shape;
}

bool axis_separates(const Shape& a, const Shape& b, const Vec3d& axis, double gap) {
  const double size = vec::length(axis);
  if (!(size > 1e-30)) return false;
  const auto range = [&axis](std::span<const Vec3d> points) {
    double low = vec::dot(points[0], axis);
    double high = low;
    for (const Vec3d& point : points.subspan(1)) {
      const double value = vec::dot(point, axis);
      low = std::min(low, value);
      high = std::max(high, value);
    }
    return std::array<double, 2>{low, high};
  };
  const auto range_a = range(a.points);
  const auto range_b = range(b.points);
  return std::max(range_b[0] - range_a[1], range_a[0] - range_b[1]) > gap * size;
}

}  // namespace

bool apart(std::span<const Vec3d> a, std::span<const Vec3d> b, double gap) {
  const Shape first = shape_of(a);
  const Shape second = shape_of(b);
  const auto separates = [&](const Vec3d& axis) { return axis_separates(first, second, axis, gap); };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3d unit_axis{0, 0, 0};
    unit_axis[axis] = 1;
    if (separates(unit_axis)) return true;
  }
  if (separates(first.normal) || separates(second.normal)) return true;
  for (std::size_t i = 0; i < first.edge_count; ++i) {
    // Edges' normals within the plane settle shapes that lie in one plane.
    if (separates(vec::cross(first.normal, first.edges[i])) || separates(vec::cross(second.normal, first.edges[i])))
      return true;
    for (std::size_t j = 0; j < second.edge_count; ++j) {
      if (separates(vec::cross(first.edges[i], second.edges[j]))) return true;
    }
  }
  for (std::size_t j = 0; j < second.edge_count; ++j) {
    if (separates(vec::cross(second.normal, second.edges[j])) || separates(vec::cross(first.normal, second.edges[j])))
      return true;
  }
  return false;
}

}  // namespace torolux
