// SPDX-License-Identifier: MIT
// Walls: where other polygons stand on a triangle, pass through it or lie close over it. Light differs from one side of
// them to the other, so no element should lie across, and no interpolation go through (D. Baum, S. Mann, K. Smith,
// J. Winget, "Making radiosity usable", SIGGRAPH 1991).
#pragma once

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "host_tools/mesh/wall_index.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

struct Mesh;

class Walls {
 public:
  /// wanted: by triangle, whether its walls are asked for.
  Walls(const Mesh& mesh, const std::vector<bool>& wanted);
  /// None anywhere.
  Walls() = default;

  /// Whether a wall of either side passes through the inside of a triangle of the grid: so far from its edges, of the
  /// way to its centre, that little lies beyond.
  bool cross(std::uint32_t triangle, std::uint32_t code) const { return pass_inside(triangle, code, 0.04); }
  /// Or so far that next to nothing does, but more than rounding.
  bool touch(std::uint32_t triangle, std::uint32_t code) const { return pass_inside(triangle, code, 0.002); }
  /// Whether a wall on one side (0 front, 1 back) lies between two points of a triangle, or at the second one.
  bool between(std::uint32_t triangle, std::uint32_t side, const PlanePoint& from, const PlanePoint& to) const;
  /// Whether a wall on either side lies between two points of a triangle.
  bool part(std::uint32_t triangle, const PlanePoint& a, const PlanePoint& b) const;

 private:
  bool pass_inside(std::uint32_t triangle, std::uint32_t code, double inside) const;
  void index(std::uint32_t triangle);

  std::vector<std::array<std::vector<WallSegment>, 2>> of_side_;  ///< by triangle
  std::unordered_map<std::uint32_t, WallIndex> index_;            ///< of triangles with many walls
};

}  // namespace torolux
