// SPDX-License-Identifier: MIT
// Ear clipping (Meisters 1975) of planar and nearly planar polygons in space.
#include "host_tools/scene/polygon_triangles.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

using Point = std::array<double, 2>;

double cross(const Point& o, const Point& a, const Point& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

double squared_distance(const Point& a, const Point& b) {
  return (a[0] - b[0]) * (a[0] - b[0]) + (a[1] - b[1]) * (a[1] - b[1]);
}

std::optional<std::array<std::size_t, 2>> axes_across(const Vec3d& normal) {
  std::size_t away = 0;
  for (std::size_t axis = 1; axis < 3; ++axis)
    if (std::abs(normal[axis]) > std::abs(normal[away])) away = axis;
  if (!(std::abs(normal[away]) > 0)) return std::nullopt;
  std::array axes{(away + 1) % 3, (away + 2) % 3};
  if (normal[away] < 0) std::swap(axes[0], axes[1]);
  return axes;
}

/// Twice the areas of the triangles of a fan from the first corner: their sum (Newell's normal), and the longest.
struct FanAreas {
  Vec3d sum{0, 0, 0}, longest{0, 0, 0};
};
FanAreas fan_areas(std::span<const Vec3d> corners) {
  FanAreas areas;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3d a = vec::subtract(corners[i], corners[0]);
    const Vec3d b = vec::subtract(corners[(i + 1) % corners.size()], corners[0]);
    const Vec3d area = vec::cross(a, b);
    areas.sum = vec::add(areas.sum, area);
    if (vec::dot(area, area) > vec::dot(areas.longest, areas.longest)) areas.longest = area;
  }
  return areas;
}

/// Corners in the plane, counter-clockwise; empty where the polygon has no area. balanced: what it encloses one way
/// round is as much as the other way, so it has an area and none in sum.
std::vector<Point> flattened(std::span<const Vec3d> corners, bool& balanced) {
  const FanAreas areas = fan_areas(corners);
  constexpr double rounding = 1e-9;
  balanced = vec::length(areas.sum) <= rounding * vec::length(areas.longest);
  const auto axes = axes_across(balanced ? areas.longest : areas.sum);
  if (!axes) return {};
  const auto [u, v] = *axes;
  std::vector<Point> points;
  points.reserve(corners.size());
  for (const Vec3d& corner : corners) points.push_back({corner[u] - corners[0][u], corner[v] - corners[0][v]});
  return points;
}

class EarClipper {
 public:
  explicit EarClipper(std::vector<Point> points) : points_(std::move(points)), left_(points_.size()) {
    std::iota(left_.begin(), left_.end(), std::uint32_t{0});
  }

  PolygonTriangles run() {
    while (left_.size() > 3) {
      std::size_t ear = best_ear();
      if (ear == left_.size()) {
        result_.crosses_itself = true;
        ear = widest_corner();
      }
      cut(ear);
    }
    if (turn(1) != 0) cut(1);
    return std::move(result_);
  }

 private:
  /// Beyond this many corners the first ear found is taken: choosing costs a square more.
  static constexpr std::size_t kChooseUpTo = 256;

  std::uint32_t at(std::size_t i) const { return left_[i % left_.size()]; }
  std::uint32_t before(std::size_t i) const { return at(i + left_.size() - 1); }
  double turn(std::size_t i) const { return cross(points_[before(i)], points_[at(i)], points_[at(i + 1)]); }

  /// Twice the area over the square of the longest edge.
  double roundness(std::size_t i) const {
    const Point& a = points_[before(i)];
    const Point& b = points_[at(i)];
    const Point& c = points_[at(i + 1)];
    return turn(i) / std::max({squared_distance(a, b), squared_distance(b, c), squared_distance(c, a)});
  }

  bool is_ear(std::size_t i) const {
    if (!(turn(i) > 0)) return false;
    const Point& a = points_[before(i)];
    const Point& b = points_[at(i)];
    const Point& c = points_[at(i + 1)];
    // Only corners that are not convex can lie inside; those on an edge block as well, so that they stay corners.
    for (const std::size_t k : blunt_) {
      const Point& p = points_[left_[k]];
      if (p == a || p == b || p == c) continue;
      if (cross(a, b, p) >= 0 && cross(b, c, p) >= 0 && cross(c, a, p) >= 0) return false;
    }
    return true;
  }

  std::size_t best_ear() {
    blunt_.clear();
    for (std::size_t i = 0; i < left_.size(); ++i)
      if (!(turn(i) > 0)) blunt_.push_back(i);
    std::size_t best = left_.size();
    double best_roundness = 0;
    for (std::size_t k = 1; k <= left_.size(); ++k) {
      const std::size_t i = k % left_.size();
      const double round = turn(i) > 0 ? roundness(i) : 0;
      // The margin keeps equal ears in their order, whatever the rounding.
      if (round > best_roundness * (1 + 1e-9) && is_ear(i)) {
        if (left_.size() > kChooseUpTo) return i;
        best = i;
        best_roundness = round;
      }
    }
    return best;
  }

  std::size_t widest_corner() const {
    std::size_t widest = 0;
    for (std::size_t i = 1; i < left_.size(); ++i)
      if (turn(i) > turn(widest)) widest = i;
    return widest;
  }

  void cut(std::size_t i) {
    if (turn(i) != 0) result_.triangles.push_back({before(i), at(i), at(i + 1)});
    left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(i));
  }

  std::vector<Point> points_;
  std::vector<std::uint32_t> left_;
  std::vector<std::size_t> blunt_;
  PolygonTriangles result_;
};

}  // namespace

std::optional<std::array<std::size_t, 2>> plane_axes(std::span<const Vec3d> corners) {
  return axes_across(fan_areas(corners).sum);
}

PolygonTriangles cut_polygon(std::span<const Vec3d> corners) {
  if (corners.size() < 3) return {};
  if (corners.size() == 3) return {{{0, 1, 2}}, false};
  bool balanced = false;
  std::vector<Point> points = flattened(corners, balanced);
  if (points.empty()) return {};
  PolygonTriangles cut = EarClipper(std::move(points)).run();
  cut.crosses_itself = cut.crosses_itself || (balanced && !cut.triangles.empty());
  return cut;
}

}  // namespace torolux
