// SPDX-License-Identifier: MIT
// A triangle looks out from the plane that its surface has there. Of two sides with light the back may be the inside of
// a thin thing, where all is near and nobody looks: the front decides.
#include "host_tools/mesh/clearance.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "firmware/protocol/stores.hpp"
#include "host_tools/mesh/edges.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {
namespace {

/// Of the reach: surfaces that meet without a common edge are uneven there, and what lies closer over a surface hides
/// it.
constexpr double kRise = 0.05;
/// Cosine of 60 degrees: what is steeper stands on the surface.
constexpr double kLiesOver = 0.5;
/// What rises from an edge is as far from a point of the edge's normal as this one is high, times the angle's cosine.
/// It is looked for so high, in lengths of the edge, and counts up to this cosine, of 41 and 139 degrees.
constexpr double kLookedAt = 0.125;
constexpr double kCosine = 0.75;

Vec3d normal_of(const MeshTriangle& triangle) {
  const Vec3d first = to_double(triangle.corner[0]);
  return vec::unit(vec::cross(vec::subtract(to_double(triangle.corner[1]), first),
                              vec::subtract(to_double(triangle.corner[2]), first)));
}

/// By triangle: the lowest number of one that hangs together with it, over edges where none stands on the other.
std::vector<std::uint32_t> surfaces_of(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> positions;
  positions.reserve(mesh.triangles.size());
  for (const MeshTriangle& triangle : mesh.triangles) positions.push_back(triangle.position);
  DisjointSets sets(positions.size());
  for_each_edge(edge_uses(positions), [&](std::span<const EdgeUse> uses) {
    for (std::size_t i = 1; i < uses.size(); ++i) {
      const std::uint32_t a = uses[i - 1].triangle;
      const std::uint32_t b = uses[i].triangle;
      const double wound_alike = uses[i - 1].forward != uses[i].forward ? 1 : -1;
      const double cosine = vec::dot(normal_of(mesh.triangles[a]), normal_of(mesh.triangles[b]));
      if (wound_alike * cosine >= kLiesOver) sets.merge(a, b);
    }
  });
  std::vector<std::uint32_t> surface;
  surface.reserve(positions.size());
  for (std::uint32_t t = 0; t < positions.size(); ++t) surface.push_back(sets.root(t));
  return surface;
}

}  // namespace

Clearance::Clearance(const Mesh& mesh) : surface_(surfaces_of(mesh)) {
  std::vector<TriangleTree::Triangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    TriangleTree::Triangle& triangle = triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) triangle.corner[i] = to_double(mesh.triangles[t].corner[i]);
    triangle.surface = surface_[t];
    sides_.push_back(mesh.triangles[t].sides);
  }
  tree_ = TriangleTree(std::move(triangles));
}

double Clearance::before(std::uint32_t triangle, Outlook outlook, double reach) const {
  if (surface_.empty()) return reach;
  outlook.own = surface_[triangle];
  outlook.rise = kRise * reach;
  if ((sides_[triangle] & protocol::kFrontPresent) == 0) outlook.normal = vec::scale(outlook.normal, -1);
  return tree_.distance(outlook, reach);
}

double Clearance::at(std::uint32_t triangle, const Vec3d& point, const Vec3d& normal, double reach) const {
  return before(triangle, {.point = point, .normal = normal}, reach);
}

bool Clearance::is_overhung(std::uint32_t triangle, const std::array<Vec3d, 3>& corner) const {
  const auto& [a, b, c] = corner;
  const double longest =
      std::max({vec::length(vec::subtract(b, a)), vec::length(vec::subtract(c, b)), vec::length(vec::subtract(a, c))});
  const Outlook outlook{.point = vec::scale(vec::add(vec::add(a, b), c), 1.0 / 3),
                        .normal = vec::unit(vec::cross(vec::subtract(b, a), vec::subtract(c, a))),
                        .facing = kLiesOver};
  return before(triangle, outlook, longest) < longest;
}

bool Clearance::rises_from(std::uint32_t triangle, const Vec3d& normal, const Vec3d& from, const Vec3d& to) const {
  if (surface_.empty()) return false;
  const double height = kLookedAt * vec::length(vec::subtract(to, from));
  const Vec3d middle = vec::scale(vec::add(from, to), 0.5);
  const Outlook outlook{.point = vec::add(middle, vec::scale(normal, height)),
                        .normal = normal,
                        .rise = -height,
                        .own = surface_[triangle]};
  return tree_.distance(outlook, kCosine * height) < kCosine * height;
}

}  // namespace torolux
