// SPDX-License-Identifier: MIT
// What can be said of shapes without cutting them into triangles: how many there would be, true areas, bounds.
#include <cmath>
#include <numbers>

#include "host_tools/scene/shapes.hpp"

namespace torolux {
namespace {

struct CountTriangles {
  Roundness roundness;

  std::size_t operator()(const Sphere& sphere) const {
    const std::size_t parts = parts_of_edge(roundness.edges(std::abs(sphere.radius)));
    return 20 * parts * parts;
  }
  std::size_t operator()(const Cone& cone) const {
    const double larger = std::max(std::abs(cone.radius_from), std::abs(cone.radius_to));
    return std::size_t{cone.radius_from != 0 && cone.radius_to != 0 ? 2U : 1U} * roundness.edges(larger);
  }
  std::size_t operator()(const Ring& ring) const {
    return std::size_t{ring.inner > 0 ? 2U : 1U} * roundness.edges(ring.outer);
  }
  std::size_t operator()(const Quad& quad) const {
    static_cast<void>(quad);
    return 2;
  }
  std::size_t operator()(const Box& box) const {
    static_cast<void>(box);
    return 12;
  }
  std::size_t operator()(const RingTorus& torus) const {
    const double outer = std::abs(torus.outer);
    return std::size_t{2} * roundness.edges(outer) * roundness.edges(0.5 * (outer - std::abs(torus.inner)));
  }
};

struct TrueArea {
  /// Two triangles: it may be bent.
  double operator()(const Quad& quad) const {
    const auto half = [&quad](std::size_t i) {
      return 0.5 * vec::length(vec::cross(vec::subtract(quad.corners[i], quad.corners[0]),
                                          vec::subtract(quad.corners[i + 1], quad.corners[0])));
    };
    return half(1) + half(2);
  }
  double operator()(const Box& box) const {
    double sum = 0;
    for (std::size_t axis = 0; axis < 3; ++axis) sum += 2 * (*this)(face(box, axis, true));
    return sum;
  }
  double operator()(const Sphere& sphere) const { return 4 * std::numbers::pi * sphere.radius * sphere.radius; }
  double operator()(const Cone& cone) const {
    const double slant = std::hypot(vec::length(vec::subtract(cone.to, cone.from)), cone.radius_from - cone.radius_to);
    return std::numbers::pi * std::abs(cone.radius_from + cone.radius_to) * slant;
  }
  double operator()(const Ring& ring) const {
    return std::numbers::pi * (ring.outer * ring.outer - ring.inner * ring.inner);
  }
  double operator()(const RingTorus& torus) const {
    return std::numbers::pi * std::numbers::pi * (torus.outer * torus.outer - torus.inner * torus.inner);
  }
};

/// Of a circle about an axis of any length: each coordinate goes as far as the axis leans away from it.
void include_circle(vec::Box& box, const Vec3d& centre, const Vec3d& axis, double radius) {
  const Vec3d unit = vec::unit(axis);
  Vec3d reach{};
  for (std::size_t i = 0; i < 3; ++i) reach[i] = std::abs(radius) * std::sqrt(std::max(0.0, 1 - unit[i] * unit[i]));
  box.include(vec::subtract(centre, reach));
  box.include(vec::add(centre, reach));
}

struct BoundsOf {
  vec::Box operator()(const Quad& quad) const {
    vec::Box box;
    for (const Vec3d& corner : quad.corners) box.include(corner);
    return box;
  }
  vec::Box operator()(const Box& solid) const {
    vec::Box box;
    for (const bool upper : {false, true})
      for (const Vec3d& corner : face(solid, 0, upper).corners) box.include(corner);
    return box;
  }
  vec::Box operator()(const Sphere& sphere) const {
    vec::Box box;
    const double r = std::abs(sphere.radius);
    box.include(vec::subtract(sphere.centre, {r, r, r}));
    box.include(vec::add(sphere.centre, {r, r, r}));
    return box;
  }
  vec::Box operator()(const Cone& cone) const {
    vec::Box box;
    const Vec3d along = vec::subtract(cone.to, cone.from);
    include_circle(box, cone.from, along, cone.radius_from);
    include_circle(box, cone.to, along, cone.radius_to);
    return box;
  }
  vec::Box operator()(const Ring& ring) const {
    vec::Box box;
    include_circle(box, ring.centre, ring.normal, ring.outer);
    return box;
  }
  vec::Box operator()(const RingTorus& torus) const {
    const double tube = 0.5 * (std::abs(torus.outer) - std::abs(torus.inner));
    vec::Box middle;
    include_circle(middle, torus.centre, torus.normal, std::abs(torus.outer) - tube);
    vec::Box box;
    box.include(vec::subtract(middle.low, {tube, tube, tube}));
    box.include(vec::add(middle.high, {tube, tube, tube}));
    return box;
  }
};

}  // namespace

std::size_t triangles_of(const Shape& shape, const Roundness& roundness) {
  return std::visit(CountTriangles{roundness}, shape);
}

double area(const Shape& shape) {
  return std::visit(TrueArea{}, shape);
}

vec::Box bounds(const Shape& shape) {
  return std::visit(BoundsOf{}, shape);
}

}  // namespace torolux
