// SPDX-License-Identifier: MIT
// A convex piece and a convex outline in one plane in; what of the piece lies outside, in convex pieces, out.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "host_tools/scene/near_vertices.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

using PositionPolygon = std::vector<std::uint32_t>;  ///< positions of a scene, in the winding of their triangle

/// How far a point lies to the left of a line from a to b, seen with the normal (of length 1) towards the eye.
double side_of(const Vec3d& point, const Vec3d& a, const Vec3d& b, const Vec3d& normal);

class ConvexCut {
 public:
  /// Corners that it makes are put into `vertices`. near: what is shorter is nothing [scene units].
  ConvexCut(Scene& scene, NearVertices& vertices, double near) : scene_(scene), vertices_(vertices), near_(near) {}

  /// Adds to `left` what of a convex piece lies outside of a convex outline, which may be wound either way. normal: of
  /// the piece. True: not all of it does.
  bool take_away(const PositionPolygon& piece, const PositionPolygon& outline, const Vec3d& normal,
                 std::vector<PositionPolygon>& left);

 private:
  const Vec3d& at(std::uint32_t p) const { return scene_.positions[p]; }
  /// Below 0: it runs clockwise, seen with the normal towards the eye.
  double doubled_area(const PositionPolygon& polygon, const Vec3d& normal) const;
  /// Where an edge meets a line; the same for both ways to run through it.
  std::uint32_t crossing(std::uint32_t a, std::uint32_t b, double side_a, double side_b);
  /// The parts of a convex polygon to the left and to the right of a line.
  std::pair<PositionPolygon, PositionPolygon> split(const PositionPolygon& polygon, const Vec3d& a, const Vec3d& b,
                                                    const Vec3d& normal);
  /// Whether an edge of a polygon, counter-clockwise about `up`, has all of another on its outer side.
  bool parted_by(const PositionPolygon& polygon, const PositionPolygon& other, const Vec3d& up) const;

  Scene& scene_;
  NearVertices& vertices_;
  double near_;
};

}  // namespace torolux
