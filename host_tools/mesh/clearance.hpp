// SPDX-License-Identifier: MIT
// A mesh enters; how far other surfaces are in front of one leaves: light changes within about that length (G. Ward,
// P. Heckbert, "Irradiance gradients", Eurographics Workshop on Rendering 1992).
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/mesh/triangle_tree.hpp"

namespace torolux {

struct Mesh;

/// Lengths normalised. Triangles that hang together over edges where they turn by less than 60 degrees are one surface.
class Clearance {
 public:
  Clearance() = default;  ///< all is clear
  /// Triangles and sides of it must be known.
  explicit Clearance(const Mesh& mesh);

  /// Before the front of a triangle, or the back of one that has no front with light, from a point of its surface: to
  /// the nearest other one, at most reach. What rises less than a twentieth of reach over the plane there does not
  /// count.
  double at(std::uint32_t triangle, const Vec3d& point, const Vec3d& normal, double reach) const;

  /// Whether from the middle of a part of the triangle another surface is nearer than the part is long, and lies over
  /// it rather than stands on it: steeper than 60 degrees it does not count.
  bool is_overhung(std::uint32_t triangle, const std::array<Vec3d, 3>& corner) const;

  /// Whether another surface rises from the middle of an edge in the triangle, given by its ends, on the side to which
  /// the normal points: by 41 to 139 degrees; one that shares an edge with the triangle's surface, by up to 120.
  bool rises_from(std::uint32_t triangle, const Vec3d& normal, const Vec3d& from, const Vec3d& to) const;

 private:
  /// outlook: of the front; own and rise are set here.
  double before(std::uint32_t triangle, Outlook outlook, double reach) const;

  TriangleTree tree_;
  std::vector<std::uint32_t> surface_;  ///< by triangle
  std::vector<std::uint8_t> sides_;     ///< likewise
};

}  // namespace torolux
