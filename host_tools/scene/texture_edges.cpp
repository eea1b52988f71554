// SPDX-License-Identifier: MIT
// Splits a triangle at the lines u = 0, u = 1, v = 0 and v = 1.
#include "host_tools/scene/texture_edges.hpp"

#include <algorithm>
#include <cmath>

namespace torolux {
namespace {

struct Corner {
  TexturePoint2 point;
  CutOutCorner weights;
};
using Corners = std::vector<Corner>;

/// The part of a convex polygon where sign * coordinate >= sign * edge.
Corners half_of(const Corners& polygon, std::size_t axis, double edge, double sign) {
  Corners kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Corner& p = polygon[i];
    const Corner& q = polygon[(i + 1) % polygon.size()];
    const double here = sign * (p.point[axis] - edge);
    const double there = sign * (q.point[axis] - edge);
    if (here >= 0) kept.push_back(p);
    if (!((here > 0 && there < 0) || (here < 0 && there > 0))) continue;
    const double t = here / (here - there);
    Corner between;
    for (std::size_t k = 0; k < 2; ++k) between.point[k] = p.point[k] + t * (q.point[k] - p.point[k]);
    for (std::size_t k = 0; k < 3; ++k) between.weights[k] = p.weights[k] + t * (q.weights[k] - p.weights[k]);
    between.point[axis] = edge;
    kept.push_back(between);
  }
  return kept;
}

/// Of the triangle: twice a part's.
double area_of(const CutOutPart& part) {
  const auto& [a, b, c] = part;
  return std::abs((b[1] - a[1]) * (c[2] - a[2]) - (b[2] - a[2]) * (c[1] - a[1]));
}

}  // namespace

std::vector<CutOutPart> parts_at_edges(const std::array<TexturePoint2, 3>& points) {
  std::vector<Corners> polygons{{{points[0], {1, 0, 0}}, {points[1], {0, 1, 0}}, {points[2], {0, 0, 1}}}};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    for (const double edge : {0.0, 1.0}) {
      std::vector<Corners> next;
      for (const Corners& polygon : polygons) {
        const auto beyond = [&](const Corner& c) { return c.point[axis] > edge; };
        // What lies in the line is whole.
        for (const double sign : {-1.0, 1.0})
          if (sign < 0 || std::ranges::any_of(polygon, beyond)) next.push_back(half_of(polygon, axis, edge, sign));
      }
      polygons = std::move(next);
    }
  }
  std::vector<CutOutPart> parts;
  for (const Corners& polygon : polygons) {
    for (std::size_t i = 2; i < polygon.size(); ++i) {
      const CutOutPart part{polygon[0].weights, polygon[i - 1].weights, polygon[i].weights};
      if (area_of(part) > 1e-9) parts.push_back(part);
    }
  }
  return parts;
}

void clamp_to_edges(std::array<TexturePoint2, 3>& points) {
  for (TexturePoint2& point : points)
    for (double& x : point) x = std::clamp(x, 0.0, 1.0);
}

}  // namespace torolux
