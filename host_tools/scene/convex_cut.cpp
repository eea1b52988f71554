// SPDX-License-Identifier: MIT
// Cuts by one edge of the outline after the other (I. Sutherland, G. Hodgman, "Reentrant polygon clipping", 1974), and
// keeps what falls off.
#include "host_tools/scene/convex_cut.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/scene/vec.hpp"

namespace torolux {

double side_of(const Vec3d& point, const Vec3d& a, const Vec3d& b, const Vec3d& normal) {
  const Vec3d along = vec::subtract(b, a);
  const double length = vec::length(along);
  return length > 0 ? vec::dot(normal, vec::cross(along, vec::subtract(point, a))) / length : 0;
}

double ConvexCut::doubled_area(const PositionPolygon& polygon, const Vec3d& normal) const {
  Vec3d sum{0, 0, 0};
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    sum = vec::add(sum, vec::cross(vec::subtract(at(polygon[i]), at(polygon[0])),
                                   vec::subtract(at(polygon[i + 1]), at(polygon[0]))));
  return vec::dot(sum, normal);
}

std::uint32_t ConvexCut::crossing(std::uint32_t a, std::uint32_t b, double side_a, double side_b) {
  if (a > b) {
    std::swap(a, b);
    std::swap(side_a, side_b);
  }
  const Vec3d from = at(a);
  const Vec3d along = vec::subtract(at(b), from);
  return vertices_.at(vec::add(from, vec::scale(along, side_a / (side_a - side_b))));
}

std::pair<PositionPolygon, PositionPolygon> ConvexCut::split(const PositionPolygon& polygon, const Vec3d& a,
                                                             const Vec3d& b, const Vec3d& normal) {
  std::pair<PositionPolygon, PositionPolygon> parts;
  const auto put = [](PositionPolygon& part, std::uint32_t p) {
    if (part.empty() || part.back() != p) part.push_back(p);
  };
  std::vector<double> side;
  for (const std::uint32_t p : polygon) {
    const double distance = side_of(at(p), a, b, normal);
    side.push_back(std::abs(distance) <= near_ ? 0 : distance);
  }
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t k = (i + 1) % polygon.size();
    if (side[i] >= 0) put(parts.first, polygon[i]);
    if (side[i] <= 0) put(parts.second, polygon[i]);
    if (side[i] * side[k] >= 0) continue;
    const std::uint32_t p = crossing(polygon[i], polygon[k], side[i], side[k]);
    put(parts.first, p);
    put(parts.second, p);
  }
  for (PositionPolygon* part : {&parts.first, &parts.second}) {
    while (part->size() > 1 && part->back() == part->front()) part->pop_back();
    if (part->size() < 3 || 0.5 * std::abs(doubled_area(*part, normal)) <= near_ * near_) part->clear();
  }
  return parts;
}

bool ConvexCut::take_away(const PositionPolygon& piece, const PositionPolygon& outline, const Vec3d& normal,
                          std::vector<PositionPolygon>& left) {
  const Vec3d up = vec::scale(normal, doubled_area(outline, normal) < 0 ? -1 : 1);
  if (parted_by(outline, piece, up) || parted_by(piece, outline, normal)) {
    left.push_back(piece);
    return false;
  }
  const std::size_t positions = scene_.positions.size();
  std::vector<PositionPolygon> outside;
  PositionPolygon inside = piece;
  for (std::size_t i = 0; i < outline.size() && !inside.empty(); ++i) {
    const Vec3d a = at(outline[i]);
    const Vec3d b = at(outline[(i + 1) % outline.size()]);
    auto [within, without] = split(inside, a, b, up);
    if (!without.empty()) outside.push_back(std::move(without));
    inside = std::move(within);
  }
  if (inside.empty()) {
    vertices_.forget_from(positions);
    left.push_back(piece);
    return false;
  }
  left.insert(left.end(), outside.begin(), outside.end());
  return true;
}

bool ConvexCut::parted_by(const PositionPolygon& polygon, const PositionPolygon& other, const Vec3d& up) const {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3d& a = at(polygon[i]);
    const Vec3d along = vec::subtract(at(polygon[(i + 1) % polygon.size()]), a);
    const double length = vec::length(along);
    // As side_of has it, with the length worked out once.
    const auto is_outside = [&](std::uint32_t p) {
      return vec::dot(up, vec::cross(along, vec::subtract(at(p), a))) / length <= near_;
    };
    if (!(length > 0) || std::ranges::all_of(other, is_outside)) return true;
  }
  return false;
}

}  // namespace torolux
