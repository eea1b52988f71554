// SPDX-License-Identifier: MIT
// Counts a ray's crossings of a closed surface in a tree of boxes.
#include "host_tools/mesh/solid_angle.hpp"

#include <algorithm>
#include <numbers>

namespace torolux {
namespace {

/// With fewer triangles the plain sum is as fast.
constexpr std::size_t kFewTriangles = 32;
constexpr std::uint32_t kLeaf = 4;
constexpr const Vec3d& kDirection = SolidAngle::kDirection;

/// A corner as a ray from the origin sees it: across the ray, and along.
struct Seen {
  double x, y, along;
};

Seen seen(const Vec3d& corner, const Vec3d& point) {
  const Vec3d v = vec::subtract(corner, point);
  return {v[0] - v[1] * (kDirection[0] / kDirection[1]), v[2] - v[1] * (kDirection[2] / kDirection[1]), v[1]};
}

/// On which side of an edge the ray passes, exactly, so that all triangles at a corner agree. On the edge itself: as if
/// the ray were moved along x by next to nothing, and along y by still less.
bool passes_left(const Seen& a, const Seen& b) {
  const double product = a.y * b.x;
  const double rest = std::fma(-a.y, b.x, product);
  const double side = std::fma(a.x, b.y, -product) + rest;
  if (side != 0) return side > 0;
  return a.y != b.y ? b.y < a.y : b.x > a.x;
}

/// 1: leaves by the triangle's front; -1: enters; 0: passes by.
int crossing(const SolidAngle::Triangle& triangle, const Vec3d& point) {
  const std::array<Seen, 3> at{seen(triangle[0], point), seen(triangle[1], point), seen(triangle[2], point)};
  const bool left = passes_left(at[0], at[1]);
  if (passes_left(at[1], at[2]) != left || passes_left(at[2], at[0]) != left) return 0;
  const auto ahead = std::ranges::count_if(at, [](const Seen& corner) { return corner.along > 0; });
  if (ahead == 0) return 0;
  if (ahead < 3) {
    const Vec3d a = vec::subtract(triangle[0], point);
    const Vec3d normal = vec::cross(vec::subtract(triangle[1], triangle[0]), vec::subtract(triangle[2], triangle[0]));
    if ((vec::dot(normal, a) > 0) == left) return 0;  // behind the point
  }
  return left ? -1 : 1;
}

bool meets(const vec::Box& box, const Vec3d& point) {
  double enter = 0;
  double leave = HUGE_VAL;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    enter = std::max(enter, (box.low[axis] - point[axis]) / kDirection[axis]);
    leave = std::min(leave, (box.high[axis] - point[axis]) / kDirection[axis]);
  }
  // A little wider, for rounding.
  return enter <= leave + 1e-9;
}

}  // namespace

SolidAngle::SolidAngle(std::vector<Triangle> triangles, std::span<const std::array<Vec3d, 2>> border)
    : triangles_(std::move(triangles)) {
  if (triangles_.size() <= std::max(kFewTriangles, 2 * border.size())) return;
  Vec3d middle{0, 0, 0};
  for (const auto& [from, to] : border)
    middle = vec::add(middle, vec::scale(from, 1 / static_cast<double>(border.size())));
  for (const auto& [from, to] : border) fan_.push_back({to, from, middle});
  triangles_.insert(triangles_.end(), fan_.begin(), fan_.end());
  build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void SolidAngle::build(std::uint32_t first, std::uint32_t count) {
  const std::size_t own = nodes_.size();
  nodes_.emplace_back();
  vec::Box box;
  for (std::uint32_t t = first; t < first + count; ++t)
    for (const Vec3d& corner : triangles_[t]) box.include(corner);
  nodes_[own].box = box;
  if (count <= kLeaf) {
    nodes_[own].first = first;
    nodes_[own].count = count;
    return;
  }
  std::size_t axis = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (box.extent()[i] > box.extent()[axis]) axis = i;
  const auto begin = triangles_.begin() + first;
  const auto key = [axis](const Triangle& t) { return t[0][axis] + t[1][axis] + t[2][axis]; };
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&key](const Triangle& a, const Triangle& b) { return key(a) < key(b); });
  build(first, count / 2);
  nodes_[own].right = static_cast<std::uint32_t>(nodes_.size());
  build(first + count / 2, count - count / 2);
}

int SolidAngle::crossings(const Vec3d& point) const {
  std::array<std::uint32_t, 64> open{};
  std::size_t depth = 1;
  int sum = 0;
  while (depth > 0) {
    const std::uint32_t at = open[--depth];
    const Node& node = nodes_[at];
    if (!meets(node.box, point)) continue;
    for (std::uint32_t t = node.first; t < node.first + node.count; ++t) sum += crossing(triangles_[t], point);
    if (node.count > 0) continue;
    open[depth++] = node.right;
    open[depth++] = at + 1;
  }
  return sum;
}

double SolidAngle::seen_from(const Vec3d& point) const {
  double angle = 0;
  if (nodes_.empty()) {
    for (const Triangle& triangle : triangles_) angle += vec::solid_angle(triangle, point);
    return angle;
  }
  for (const Triangle& triangle : fan_) angle -= vec::solid_angle(triangle, point);
  return angle + 4 * std::numbers::pi * crossings(point);
}

}  // namespace torolux
