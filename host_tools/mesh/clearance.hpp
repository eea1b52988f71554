// SPDX-License-Identifier: MIT
// A mesh with its smooth surfaces enters; how far others are in front of them leaves: light changes within about that
// length (G. Ward, P. Heckbert, "Irradiance gradients", Eurographics Workshop on Rendering 1992).
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/mesh/triangle_tree.hpp"

namespace torolux {

struct Mesh;

/// Lengths normalised.
class Clearance {
 public:
  Clearance() = default;  ///< all is clear
  /// Triangles, sides and smooth surfaces of it must be known.
  explicit Clearance(const Mesh& mesh);

  /// Before the sides of a triangle, from a point of its smooth surface: to the nearest other surface, at most reach.
  double at(std::uint32_t triangle, const Vec3d& point, const Vec3d& normal, double reach) const;

  /// Whether from the middle of a part of the triangle another surface is nearer than the part is long, and lies over
  /// it rather than stands on it: a wall on a floor does not count.
  bool is_overhung(std::uint32_t triangle, const std::array<Vec3d, 3>& corner) const;

 private:
  double least(std::uint32_t triangle, Outlook outlook, double reach) const;

  TriangleTree tree_;
  std::vector<std::uint32_t> surface_;  ///< by triangle
  std::vector<std::uint8_t> sides_;     ///< likewise
};

}  // namespace torolux
