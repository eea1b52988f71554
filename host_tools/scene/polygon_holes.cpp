// SPDX-License-Identifier: MIT
// Joins holes to the outline around them (D. Eberly, "Triangulation by Ear Clipping").
#include "host_tools/scene/polygon_holes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host_tools/scene/polygon_triangles.hpp"

namespace torolux {
namespace {

using Point = std::array<double, 2>;
using Contour = std::vector<std::uint32_t>;

double cross(const Point& o, const Point& a, const Point& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

class Joiner {
 public:
  /// In the plane of plane_axes(), the outline counter-clockwise.
  Joiner(std::span<const Vec3d> corners, const Contour& outline) : outline_(outline) {
    std::vector<Vec3d> around;
    for (const std::uint32_t corner : outline) around.push_back(corners[corner]);
    const auto [u, v] = plane_axes(around).value_or(std::array<std::size_t, 2>{1, 2});
    points_.reserve(corners.size());
    for (const Vec3d& corner : corners) points_.push_back({corner[u], corner[v]});
  }

  void join(Contour hole) {
    if (area(hole) > 0) std::ranges::reverse(hole);
    std::rotate(hole.begin(), hole.begin() + static_cast<std::ptrdiff_t>(rightmost(hole)), hole.end());
    const std::size_t at = bridge(points_[hole[0]]);
    Contour joined(outline_.begin(), outline_.begin() + static_cast<std::ptrdiff_t>(at) + 1);
    joined.insert(joined.end(), hole.begin(), hole.end());
    joined.push_back(hole[0]);
    joined.insert(joined.end(), outline_.begin() + static_cast<std::ptrdiff_t>(at), outline_.end());
    outline_ = std::move(joined);
  }
  double rightmost_of(const Contour& hole) const { return points_[hole[rightmost(hole)]][0]; }
  const Contour& outline() const { return outline_; }

 private:
  double area(const Contour& contour) const {
    double twice = 0;
    for (std::size_t i = 1; i + 1 < contour.size(); ++i)
      twice += cross(points_[contour[0]], points_[contour[i]], points_[contour[i + 1]]);
    return twice;
  }
  std::size_t rightmost(const Contour& contour) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < contour.size(); ++i)
      if (points_[contour[i]][0] > points_[contour[best]][0]) best = i;
    return best;
  }

  /// Where in the outline a seam from this point may end. A ray rightwards meets an edge first; that edge's corner
  /// farther right is seen from the point, unless others stand in the triangle between: then the one of them nearest to
  /// the ray in angle.
  std::size_t bridge(const Point& from) const {
    const std::size_t n = outline_.size();
    double met = std::numeric_limits<double>::infinity();
    std::size_t end = n;
    for (std::size_t i = 0; i < n; ++i) {
      const Point& a = points_[outline_[i]];
      const Point& b = points_[outline_[(i + 1) % n]];
      // The outline is on the left of its edges, so that those with the point inside run upwards here.
      if (!(a[1] <= from[1] && b[1] >= from[1] && a[1] < b[1])) continue;
      const double x = a[0] + (from[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]);
      if (x < from[0] || x >= met) continue;
      met = x;
      end = a[0] > b[0] ? i : (i + 1) % n;
    }
    if (end == n) return 0;  // the hole does not lie inside; ear clipping tells
    return seen_instead(from, {met, from[1]}, end);
  }

  std::size_t seen_instead(const Point& from, const Point& met, std::size_t end) const {
    const std::size_t n = outline_.size();
    Point a = met;
    Point b = points_[outline_[end]];
    if (cross(from, a, b) < 0) std::swap(a, b);
    std::size_t best = end;
    double best_slope = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < n; ++i) {
      const Point& p = points_[outline_[i]];
      const bool inside = cross(from, a, p) >= 0 && cross(a, b, p) >= 0 && cross(b, from, p) >= 0;
      if (!inside || p[0] <= from[0] || !opens_to(i, from)) continue;
      const double slope = std::abs(p[1] - from[1]) / (p[0] - from[0]);
      const bool nearer = slope == best_slope && p[0] < points_[outline_[best]][0];
      if (slope < best_slope || nearer) {
        best = i;
        best_slope = slope;
      }
    }
    return best;
  }

  /// Whether a seam from `from` arrives at this corner within the polygon: one point may stand in the outline several
  /// times, at ends of seams.
  bool opens_to(std::size_t i, const Point& from) const {
    const std::size_t n = outline_.size();
    const Point& before = points_[outline_[(i + n - 1) % n]];
    const Point& p = points_[outline_[i]];
    const Point& after = points_[outline_[(i + 1) % n]];
    const bool left_of_both = cross(before, p, from) >= 0 && cross(p, after, from) >= 0;
    const bool left_of_one = cross(before, p, from) >= 0 || cross(p, after, from) >= 0;
    return cross(before, p, after) > 0 ? left_of_both : left_of_one;
  }

  std::vector<Point> points_;
  Contour outline_;
};

}  // namespace

std::vector<std::uint32_t> joined_contours(std::span<const Vec3d> corners,
                                           const std::vector<std::vector<std::uint32_t>>& contours) {
  Joiner joiner(corners, contours[0]);
  // From the right, so that no seam has to cross a hole that is not joined yet.
  std::vector<std::size_t> order;
  for (std::size_t i = 1; i < contours.size(); ++i) order.push_back(i);
  std::ranges::stable_sort(order, [&](std::size_t a, std::size_t b) {
    return joiner.rightmost_of(contours[a]) > joiner.rightmost_of(contours[b]);
  });
  for (const std::size_t i : order) joiner.join(contours[i]);
  return joiner.outline();
}

}  // namespace torolux
