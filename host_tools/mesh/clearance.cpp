// SPDX-License-Identifier: MIT
// Each side of a triangle looks out from the plane that its smooth surface has there.
#include "host_tools/mesh/clearance.hpp"

#include <algorithm>

#include "firmware/protocol/stores.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {
namespace {

/// Of the reach: what rises less over the plane is a surface beside, and light does not change there as it does under
/// one.
constexpr double kRise = 0.05;
/// Cosine of 60 degrees: what is steeper stands on the surface.
constexpr double kLiesOver = 0.5;

}  // namespace

Clearance::Clearance(const Mesh& mesh) : surface_(surface_numbers(mesh.smooth)) {
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

double Clearance::least(std::uint32_t triangle, Outlook outlook, double reach) const {
  if (surface_.empty()) return reach;
  outlook.own = surface_[triangle];
  outlook.rise = kRise * reach;
  double distance = reach;
  if ((sides_[triangle] & protocol::kFrontPresent) != 0) distance = tree_.distance(outlook, distance);
  outlook.normal = vec::scale(outlook.normal, -1);
  if ((sides_[triangle] & protocol::kBackPresent) != 0) distance = tree_.distance(outlook, distance);
  return distance;
}

double Clearance::at(std::uint32_t triangle, const Vec3d& point, const Vec3d& normal, double reach) const {
  return least(triangle, {.point = point, .normal = normal}, reach);
}

bool Clearance::is_overhung(std::uint32_t triangle, const std::array<Vec3d, 3>& corner) const {
  const auto& [a, b, c] = corner;
  const double longest =
      std::max({vec::length(vec::subtract(b, a)), vec::length(vec::subtract(c, b)), vec::length(vec::subtract(a, c))});
  const Outlook outlook{.point = vec::scale(vec::add(vec::add(a, b), c), 1.0 / 3),
                        .normal = vec::unit(vec::cross(vec::subtract(b, a), vec::subtract(c, a))),
                        .facing = kLiesOver};
  return least(triangle, outlook, longest) < longest;
}

}  // namespace torolux
