// SPDX-License-Identifier: MIT
// Of two boxes the nearer one is looked at first; one that is farther than what was found, or where nothing counts, is
// not.
#include "host_tools/mesh/triangle_tree.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace torolux {
namespace {

using Triangle = TriangleTree::Triangle;

constexpr std::size_t kMostInALeaf = 4;

/// A triangle from which a plane has cut a part.
struct Polygon {
  std::array<Vec3d, 4> corner{};
  std::size_t corners = 0;
};

/// Over that above which things count.
double height(const Outlook& outlook, const Vec3d& point) {
  return vec::dot(vec::subtract(point, outlook.point), outlook.normal) - outlook.rise;
}

/// What of the triangle is high enough.
Polygon part_over(const Outlook& outlook, const Triangle& triangle) {
  std::array<double, 3> over{};
  for (std::size_t i = 0; i < 3; ++i) over[i] = height(outlook, triangle.corner[i]);
  Polygon part;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if (over[i] >= 0) part.corner[part.corners++] = triangle.corner[i];
    if ((over[i] >= 0) == (over[j] >= 0)) continue;
    const double t = over[i] / (over[i] - over[j]);
    part.corner[part.corners++] =
        vec::add(triangle.corner[i], vec::scale(vec::subtract(triangle.corner[j], triangle.corner[i]), t));
  }
  return part;
}

double distance_to_edge(const Vec3d& from, const Vec3d& a, const Vec3d& b) {
  const Vec3d way = vec::subtract(b, a);
  const double length2 = vec::dot(way, way);
  const double t = length2 > 0 ? std::clamp(vec::dot(vec::subtract(from, a), way) / length2, 0.0, 1.0) : 0;
  return vec::length(vec::subtract(from, vec::add(a, vec::scale(way, t))));
}

/// normal: of the polygon's plane, length 1.
double distance_to(const Vec3d& from, const Polygon& polygon, const Vec3d& normal) {
  double nearest = HUGE_VAL;
  bool inside = polygon.corners > 0;
  for (std::size_t i = 0; i < polygon.corners; ++i) {
    const Vec3d& a = polygon.corner[i];
    const Vec3d& b = polygon.corner[(i + 1) % polygon.corners];
    nearest = std::min(nearest, distance_to_edge(from, a, b));
    inside = inside && vec::dot(vec::cross(vec::subtract(b, a), vec::subtract(from, a)), normal) > 0;
  }
  if (!inside) return nearest;
  return std::abs(vec::dot(vec::subtract(from, polygon.corner[0]), normal));
}

Vec3d normal_of(const Triangle& triangle) {
  const auto& [a, b, c] = triangle.corner;
  return vec::unit(vec::cross(vec::subtract(b, a), vec::subtract(c, a)));
}

double distance_to_box(const Vec3d& from, const vec::Box& box) {
  Vec3d way{0, 0, 0};
  for (std::size_t axis = 0; axis < 3; ++axis)
    way[axis] = std::max({box.low[axis] - from[axis], 0.0, from[axis] - box.high[axis]});
  return vec::length(way);
}

/// Of the box's highest corner.
double height_of_box(const Outlook& outlook, const vec::Box& box) {
  Vec3d highest{0, 0, 0};
  for (std::size_t axis = 0; axis < 3; ++axis)
    highest[axis] = outlook.normal[axis] > 0 ? box.high[axis] : box.low[axis];
  return height(outlook, highest);
}

vec::Box box_of(const Triangle& triangle) {
  vec::Box box;
  for (const Vec3d& corner : triangle.corner) box.include(corner);
  return box;
}

}  // namespace

TriangleTree::TriangleTree(std::vector<Triangle> triangles) : triangles_(std::move(triangles)) {
  if (triangles_.empty()) return;
  nodes_.emplace_back();
  build(0, 0, triangles_.size());
}

void TriangleTree::build(std::uint32_t node, std::size_t first, std::size_t count) {
  const std::span<Triangle> here = std::span(triangles_).subspan(first, count);
  vec::Box box;
  vec::Box centres;
  std::uint32_t surface = here.front().surface;
  for (const Triangle& triangle : here) {
    for (const Vec3d& corner : triangle.corner) box.include(corner);
    centres.include(box_of(triangle).centre());
    if (triangle.surface != surface) surface = kSeveral;
  }
  if (count <= kMostInALeaf) {
    nodes_[node] = {box, static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(count), surface};
    return;
  }
  const auto children = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node] = {box, children, 0, surface};
  nodes_.resize(nodes_.size() + 2);
  const Vec3d extent = centres.extent();
  const auto axis = static_cast<std::size_t>(std::ranges::max_element(extent) - extent.begin());
  const std::size_t half = count / 2;
  std::ranges::nth_element(here, here.begin() + static_cast<std::ptrdiff_t>(half), {},
                           [axis](const Triangle& triangle) { return box_of(triangle).centre()[axis]; });
  build(children, first, half);
  build(children + 1, first + half, count - half);
}

double TriangleTree::distance(const Outlook& outlook, double reach) const {
  double nearest = reach;
  if (!nodes_.empty() && may_count(nodes_[0], outlook)) look(nodes_[0], outlook, nearest);
  return nearest;
}

bool TriangleTree::may_count(const Node& node, const Outlook& outlook) const {
  return node.surface != outlook.own && height_of_box(outlook, node.box) > 0;
}

void TriangleTree::look(const Node& node, const Outlook& outlook, double& nearest) const {
  for (const Triangle& triangle : std::span(triangles_).subspan(node.count > 0 ? node.first : 0, node.count)) {
    if (triangle.surface == outlook.own) continue;
    const Vec3d normal = normal_of(triangle);
    if (std::abs(vec::dot(normal, outlook.normal)) < outlook.facing) continue;
    nearest = std::min(nearest, distance_to(outlook.point, part_over(outlook, triangle), normal));
  }
  if (node.count > 0) return;
  std::array<const Node*, 2> children{&nodes_[node.first], &nodes_[node.first + 1]};
  const auto distance = [&outlook](const Node* child) { return distance_to_box(outlook.point, child->box); };
  if (distance(children[1]) < distance(children[0])) std::swap(children[0], children[1]);
  for (const Node* child : children) {
    if (distance(child) < nearest && may_count(*child, outlook)) look(*child, outlook, nearest);
  }
}

}  // namespace torolux
