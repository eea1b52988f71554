// SPDX-License-Identifier: MIT
// Spheres, boxes, cones, rings and the like enter; triangles with normals leave.
#pragma once

#include <array>
#include <cstdint>
#include <variant>
#include <vector>

#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

/// Fronts outwards; inwards where the radius is negative. Radii are not zero.
struct Sphere {
  Vec3d centre;
  double radius;
};
/// The side of a truncated cone or a cylinder, without its ends. Fronts outwards, inwards where radii are negative; one
/// of them may be zero. `from` is not `to`.
struct Cone {
  Vec3d from;
  double radius_from;
  Vec3d to;
  double radius_to;
};
/// A disc, or with `inner` above zero one with a hole; its front looks along `normal` (not zero). 0 <= inner < outer.
struct Ring {
  Vec3d centre, normal;
  double inner, outer;
};
/// Turned about `normal`; inner and outer are its least and greatest distance from that axis. Fronts outwards, inwards
/// where both are negative. |inner| < |outer|, of one sign.
struct RingTorus {
  Vec3d centre, normal;
  double inner, outer;
};
/// Four corners, counter-clockwise seen from the front.
struct Quad {
  std::array<Vec3d, 4> corners;
};
/// A corner and the three edges that leave it, right-handed: then fronts look outwards.
struct Box {
  Vec3d corner;
  std::array<Vec3d, 3> edges;
};
using Shape = std::variant<Sphere, Cone, Ring, RingTorus, Quad, Box>;

/// Of the two faces across an edge the one at the corner, or at the edge's other end (upper). Its front looks outwards.
Quad face(const Box& box, std::size_t axis, bool upper);

/// How many edges a circle gets: one of few numbers (12, 16, 24, 32, 48, ...), so that neighbours of nearly equal
/// radius meet.
struct Roundness {
  double tolerance = 0;  ///< greatest distance between circle and edge, scene units; what `least` and `most` allow
  std::uint32_t least = 12, most = 64;  ///< two of those numbers

  std::uint32_t edges(double radius) const;
};

struct ShapeMesh {
  struct Triangle {
    std::array<std::uint32_t, 3> position, normal;  ///< normal: kNoNormal where it is flat
  };
  std::vector<Vec3d> positions, normals;
  std::vector<Triangle> triangles;

  double area() const;
  void flip();  ///< fronts become backs
};

/// A sphere is an icosahedron whose triangles are divided evenly; all corners lie on the true surface. Equal circles
/// (ends of a cone, border of a ring) get equal corners, so that joined shapes are closed.
ShapeMesh tessellated(const Shape& shape, const Roundness& roundness);
/// Parts of each edge of the icosahedron, which spans a little more than a sixth of a circle.
std::uint32_t parts_of_edge(std::uint32_t edges);
/// How many triangles that makes, without making them.
std::size_t triangles_of(const Shape& shape, const Roundness& roundness);
/// Of the true surface.
double area(const Shape& shape);
vec::Box bounds(const Shape& shape);

/// Two directions at right angles to `axis` (unit) and each other. Of -axis: the first the same, the second reversed.
std::array<Vec3d, 2> across(const Vec3d& axis);

}  // namespace torolux
