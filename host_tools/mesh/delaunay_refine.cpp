// SPDX-License-Identifier: MIT
// The centre of the circle around a thin triangle becomes a point, unless it lies too near to the border: then the
// border's edge is halved instead.
#include <algorithm>
#include <cmath>
#include <deque>
#include <set>

#include "host_tools/mesh/delaunay.hpp"
#include "host_tools/mesh/plane_predicates.hpp"

namespace torolux {
namespace {

/// More points than this would be a fault of ours: regions are refined to about an element's length.
constexpr std::size_t kMostPoints = 1'000'000;

PlanePoint circle_centre(const std::array<PlanePoint, 3>& corner) {
  const double bx = double(corner[1].x) - corner[0].x;
  const double by = double(corner[1].y) - corner[0].y;
  const double cx = double(corner[2].x) - corner[0].x;
  const double cy = double(corner[2].y) - corner[0].y;
  const double twice = 2 * (bx * cy - by * cx);
  const double b = bx * bx + by * by;
  const double c = cx * cx + cy * cy;
  const auto whole = [](double v) {
    return static_cast<std::int32_t>(std::lround(std::clamp<double>(v, -kMostOfPlane, kMostOfPlane)));
  };
  return {whole(corner[0].x + (cy * b - by * c) / twice), whole(corner[0].y + (bx * c - cx * b) / twice)};
}

PlanePoint middle_of(const std::array<PlanePoint, 3>& corner) {
  return {(corner[0].x + corner[1].x + corner[2].x) / 3, (corner[0].y + corner[1].y + corner[2].y) / 3};
}

}  // namespace

bool Triangulation::is_thin(const std::array<PlanePoint, 3>& corner, double least) {
  std::array<double, 3> square{};
  for (std::size_t i = 0; i < 3; ++i) square[i] = static_cast<double>(plane::square(corner[i], corner[(i + 1) % 3]));
  const auto [shortest, longest] = std::ranges::minmax(square);
  if (longest <= least * least) return false;
  const double twice_area = static_cast<double>(plane::turn(corner[0], corner[1], corner[2]));
  // Radius = product of the edges / (4 areas); squared, over the shortest edge's square: more than 2.
  const double others = square[0] * square[1] * square[2] / shortest;
  return others > 2 * 4 * twice_area * twice_area;
}

Triangulation::EdgePlace Triangulation::look(std::uint32_t from, PlanePoint towards) const {
  std::uint32_t t = from;
  const PlanePoint begin = middle_of(corners(triangles_[from]));
  for (std::size_t step = 0; step < triangles_.size(); ++step) {
    std::uint32_t i = kNone;
    bool straight = false;
    for (std::uint32_t edge = 0; edge < 3 && !straight; ++edge) {
      if (!outside_edge(t, edge, towards)) continue;
      i = edge;
      straight = plane::turn(begin, towards, points_[triangles_[t].corner[(edge + 1) % 3]]) <= 0 &&
                 plane::turn(begin, towards, points_[triangles_[t].corner[(edge + 2) % 3]]) >= 0;
    }
    if (i == kNone) return {t, kNone};
    if (triangles_[t].fixed[i]) return {t, i};
    t = triangles_[t].beside[i];
  }
  return {kNone, kNone};
}

std::vector<Triangulation::EdgePlace> Triangulation::encroached(std::uint32_t triangle, PlanePoint point) const {
  std::vector<EdgePlace> found;
  std::vector<std::uint32_t> reached{triangle};
  std::set<std::uint32_t> seen{triangle};
  while (!reached.empty()) {
    const std::uint32_t t = reached.back();
    reached.pop_back();
    for (std::uint32_t i = 0; i < 3; ++i) {
      const Triangle& here = triangles_[t];
      if (here.fixed[i]) {
        const PlanePoint a = points_[here.corner[(i + 1) % 3]];
        const PlanePoint b = points_[here.corner[(i + 2) % 3]];
        if (plane::in_half_circle(a, b, point)) found.push_back({t, i});
        continue;
      }
      const std::uint32_t u = here.beside[i];
      if (plane::in_circle(corners(triangles_[u]), point) > 0 && seen.insert(u).second) reached.push_back(u);
    }
  }
  return found;
}

bool Triangulation::halve_edge(EdgePlace edge, const Halve& halve) {
  const auto& corner = triangles_[edge.triangle].corner;
  const auto middle = halve(corner[(edge.opposite + 1) % 3] - kAround, corner[(edge.opposite + 2) % 3] - kAround);
  if (!middle) return false;
  points_.push_back(*middle);
  at_.push_back(edge.triangle);
  failed_ = !split_edge(edge.triangle, edge.opposite, static_cast<std::uint32_t>(points_.size() - 1));
  return !failed_;
}

/// False: nothing can be done for it.
bool Triangulation::improve(std::uint32_t triangle, const Halve& halve) {
  const PlanePoint centre = circle_centre(corners(triangles_[triangle]));
  const EdgePlace place = look(triangle, centre);
  if (place.triangle == kNone) return false;
  if (place.opposite != kNone) return halve_edge(place, halve);
  const auto near = encroached(place.triangle, centre);
  for (const EdgePlace& edge : near)
    if (halve_edge(edge, halve) || failed_) return !failed_;
  if (!near.empty()) return false;
  last_ = place.triangle;
  return add(centre);
}

bool Triangulation::refine(double least, const Halve& halve) {
  std::deque<std::uint32_t> waiting;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t)
    if (triangles_[t].inside) waiting.push_back(t);
  while (!failed_ && !waiting.empty() && points_.size() < kMostPoints) {
    const std::uint32_t t = waiting.front();
    waiting.pop_front();
    if (!triangles_[t].inside || !is_thin(corners(triangles_[t]), least) || !improve(t, halve)) continue;
    waiting.push_back(t);
    const auto point = static_cast<std::uint32_t>(points_.size() - 1);
    std::uint32_t around = at_[point];
    do {
      waiting.push_back(around);
      around = triangles_[around].beside[(index_of(around, point) + 1) % 3];
    } while (around != at_[point]);
  }
  return !failed_;
}

}  // namespace torolux
