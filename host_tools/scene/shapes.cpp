// SPDX-License-Identifier: MIT
// Cuts curved surfaces into triangles.
#include "host_tools/scene/shapes.hpp"

#include <cmath>
#include <map>
#include <numbers>

namespace torolux {
namespace {

constexpr std::uint32_t kCorners = 12;
constexpr std::array<std::array<std::uint32_t, 3>, 20> kIcosahedron{
    {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
     {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
     {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}}};

std::array<Vec3d, kCorners> icosahedron() {
  const double g = std::numbers::phi;
  std::array<Vec3d, kCorners> corners{{{-1, g, 0},
                                       {1, g, 0},
                                       {-1, -g, 0},
                                       {1, -g, 0},
                                       {0, -1, g},
                                       {0, 1, g},
                                       {0, -1, -g},
                                       {0, 1, -g},
                                       {g, 0, -1},
                                       {g, 0, 1},
                                       {-g, 0, -1},
                                       {-g, 0, 1}}};
  for (Vec3d& corner : corners) corner = vec::unit(corner);
  return corners;
}

/// Of a circle, in the order of rising angle; symmetric, so that one turned about has the very same corners.
std::vector<std::array<double, 2>> circle(std::uint32_t edges) {
  std::vector<std::array<double, 2>> points(edges);
  for (std::uint32_t i = 0; i < edges; ++i) {
    const std::uint32_t quarter = edges / 4;
    const std::uint32_t within = i % quarter;
    const double angle = 2 * std::numbers::pi * within / edges;
    double x = std::cos(angle);
    double y = std::sin(angle);
    if (2 * within == quarter) x = y = std::numbers::sqrt2 / 2;
    if (2 * within > quarter) {  // the same numbers as those of the first half, exchanged
      x = std::sin(2 * std::numbers::pi * (quarter - within) / edges);
      y = std::cos(2 * std::numbers::pi * (quarter - within) / edges);
    }
    constexpr std::array<std::array<double, 4>, 4> turn{{{1, 0, 0, 1}, {0, -1, 1, 0}, {-1, 0, 0, -1}, {0, 1, -1, 0}}};
    const auto& t = turn[i / quarter];
    points[i] = {t[0] * x + t[1] * y, t[2] * x + t[3] * y};
  }
  return points;
}

/// Collects corners and triangles.
class Tessellation {
 public:
  explicit Tessellation(const Roundness& roundness) : roundness_(roundness) {}

  ShapeMesh operator()(const Sphere& sphere) {
    const double radius = std::abs(sphere.radius);
    inwards_ = sphere.radius < 0;
    parts_ = parts_of_edge(roundness_.edges(radius));
    for (const Vec3d& corner : icosahedron()) add_on_sphere(sphere.centre, radius, corner);
    for (const auto& face : kIcosahedron) divide(face, sphere.centre, radius);
    return std::move(mesh_);
  }

  ShapeMesh operator()(const Cone& cone) {
    inwards_ = cone.radius_from < 0 || cone.radius_to < 0;
    const double from = std::abs(cone.radius_from);
    const double to = std::abs(cone.radius_to);
    const Vec3d along = vec::subtract(cone.to, cone.from);
    const double length = vec::length(along);
    const Vec3d axis = snapped(vec::unit(along));
    const std::array<Vec3d, 2> side = across(axis);
    const auto points = circle(roundness_.edges(std::max(from, to)));
    const auto n = static_cast<std::uint32_t>(points.size());
    add_circle(cone.from, side, from, points);
    add_circle(cone.to, side, to, points);
    // A normal leans by the change of radius; at a tip each triangle has its own.
    for (std::uint32_t i = 0; i < 2 * n; ++i) {
      const double turn = std::numbers::pi * i / n;
      const Vec3d out = vec::add(vec::scale(side[0], std::cos(turn)), vec::scale(side[1], std::sin(turn)));
      mesh_.normals.push_back(facing(vec::unit(vec::add(vec::scale(out, length), vec::scale(axis, from - to)))));
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t j = (i + 1) % n;
      const std::uint32_t middle = 2 * i + 1;
      if (from > 0) add({i, j, n + j}, {2 * i, 2 * j, to > 0 ? 2 * j : middle});
      if (to > 0) add({i, n + j, n + i}, {from > 0 ? 2 * i : middle, 2 * j, 2 * i});
    }
    return std::move(mesh_);
  }

  ShapeMesh operator()(const Ring& ring) {
    const std::array<Vec3d, 2> side = across(snapped(vec::unit(ring.normal)));
    const auto points = circle(roundness_.edges(ring.outer));
    const auto n = static_cast<std::uint32_t>(points.size());
    add_circle(ring.centre, side, ring.outer, points);
    const std::array<std::uint32_t, 3> flat{kNoNormal, kNoNormal, kNoNormal};
    if (ring.inner > 0) {
      add_circle(ring.centre, side, ring.inner, points);
    } else {
      mesh_.positions.push_back(ring.centre);
    }
    for (std::uint32_t i = 0; i < n; ++i) {
      const std::uint32_t j = (i + 1) % n;
      if (ring.inner > 0) {
        add({i, j, n + j}, flat);
        add({i, n + j, n + i}, flat);
      } else {
        add({i, j, n}, flat);
      }
    }
    return std::move(mesh_);
  }

  ShapeMesh operator()(const Quad& quad) {
    add_quad(quad);
    return std::move(mesh_);
  }

  ShapeMesh operator()(const Box& box) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (const bool upper : {false, true}) add_quad(face(box, axis, upper));
    return std::move(mesh_);
  }

  ShapeMesh operator()(const RingTorus& torus) {
    inwards_ = torus.outer < 0;
    const double outer = std::abs(torus.outer);
    const double tube = 0.5 * (outer - std::abs(torus.inner));
    const double middle = outer - tube;
    const Vec3d axis = vec::unit(torus.normal);
    const std::array<Vec3d, 2> side = across(axis);
    const auto around = circle(roundness_.edges(outer));
    const auto through = circle(roundness_.edges(tube));
    const auto n = static_cast<std::uint32_t>(around.size());
    const auto m = static_cast<std::uint32_t>(through.size());
    for (const auto& turn : around)
      for (const auto& point : through) {
        const Vec3d out = vec::add(vec::scale(side[0], turn[0]), vec::scale(side[1], turn[1]));
        const Vec3d normal = vec::add(vec::scale(out, point[0]), vec::scale(axis, point[1]));
        mesh_.positions.push_back(vec::add(torus.centre, vec::add(vec::scale(out, middle), vec::scale(normal, tube))));
        mesh_.normals.push_back(facing(normal));
      }
    for (std::uint32_t i = 0; i < n; ++i)
      for (std::uint32_t k = 0; k < m; ++k) {
        const std::uint32_t a = i * m + k;
        const std::uint32_t b = (i + 1) % n * m + k;
        const std::uint32_t c = (i + 1) % n * m + (k + 1) % m;
        const std::uint32_t d = i * m + (k + 1) % m;
        add({a, b, c}, {a, b, c});
        add({a, c, d}, {a, c, d});
      }
    return std::move(mesh_);
  }

 private:
  /// Without the last digits: directions that files give in few digits, once as a normal and once as a difference of
  /// points, become one.
  static Vec3d snapped(const Vec3d& unit) {
    constexpr double steps = 1 << 30;
    Vec3d result{};
    for (std::size_t i = 0; i < 3; ++i) result[i] = std::round(unit[i] * steps) / steps;
    return result;
  }

  Vec3d facing(const Vec3d& outwards) const { return inwards_ ? vec::scale(outwards, -1) : outwards; }

  void add_quad(const Quad& quad) {
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    mesh_.positions.insert(mesh_.positions.end(), quad.corners.begin(), quad.corners.end());
    const std::array<std::uint32_t, 3> flat{kNoNormal, kNoNormal, kNoNormal};
    add({first, first + 1, first + 2}, flat);
    add({first, first + 2, first + 3}, flat);
  }

  void add_circle(const Vec3d& centre, const std::array<Vec3d, 2>& side, double radius,
                  const std::vector<std::array<double, 2>>& points) {
    for (const auto& [x, y] : points)
      mesh_.positions.push_back(
          vec::add(centre, vec::add(vec::scale(side[0], radius * x), vec::scale(side[1], radius * y))));
  }

  void add(std::array<std::uint32_t, 3> position, std::array<std::uint32_t, 3> normal) {
    if (inwards_) {
      std::swap(position[1], position[2]);
      std::swap(normal[1], normal[2]);
    }
    mesh_.triangles.push_back({position, normal});
  }

  std::uint32_t add_on_sphere(const Vec3d& centre, double radius, const Vec3d& direction) {
    mesh_.positions.push_back(vec::add(centre, vec::scale(direction, radius)));
    mesh_.normals.push_back(facing(direction));
    directions_.push_back(direction);
    return static_cast<std::uint32_t>(mesh_.positions.size() - 1);
  }

  /// Point number `part` of an edge, counted from its lower corner, so that both faces at the edge find it.
  std::uint32_t on_edge(std::uint32_t a, std::uint32_t b, std::uint32_t part, const Vec3d& centre, double radius) {
    if (part == 0) return a;
    if (part == parts_) return b;
    if (a > b) return on_edge(b, a, parts_ - part, centre, radius);
    const auto [entry, fresh] = edges_.try_emplace({a, b, part}, 0);
    if (fresh) {
      const double share = static_cast<double>(part) / parts_;
      entry->second =
          add_on_sphere(centre, radius,
                        vec::unit(vec::add(vec::scale(directions_[a], 1 - share), vec::scale(directions_[b], share))));
    }
    return entry->second;
  }

  void divide(const std::array<std::uint32_t, 3>& face, const Vec3d& centre, double radius) {
    std::vector<std::vector<std::uint32_t>> rows(parts_ + 1);
    for (std::uint32_t row = 0; row <= parts_; ++row)
      for (std::uint32_t i = 0; i <= row; ++i) {
        // From corner 0 down; along each row from the edge to corner 1 to that to corner 2.
        if (i == 0) {
          rows[row].push_back(on_edge(face[0], face[1], row, centre, radius));
        } else if (i == row) {
          rows[row].push_back(on_edge(face[0], face[2], row, centre, radius));
        } else if (row == parts_) {
          rows[row].push_back(on_edge(face[1], face[2], i, centre, radius));
        } else {
          Vec3d sum = vec::scale(directions_[face[0]], parts_ - row);
          sum = vec::add(sum, vec::scale(directions_[face[1]], row - i));
          sum = vec::add(sum, vec::scale(directions_[face[2]], i));
          rows[row].push_back(add_on_sphere(centre, radius, vec::unit(sum)));
        }
      }
    for (std::uint32_t row = 0; row < parts_; ++row)
      for (std::uint32_t i = 0; i <= row; ++i) {
        const std::array<std::uint32_t, 3> down{rows[row][i], rows[row + 1][i], rows[row + 1][i + 1]};
        add(down, down);
        if (i == row) continue;
        const std::array<std::uint32_t, 3> up{rows[row][i], rows[row + 1][i + 1], rows[row][i + 1]};
        add(up, up);
      }
  }

  Roundness roundness_;
  ShapeMesh mesh_;
  bool inwards_ = false;
  std::uint32_t parts_ = 1;
  std::vector<Vec3d> directions_;
  std::map<std::array<std::uint32_t, 3>, std::uint32_t> edges_;
};

}  // namespace

std::uint32_t Roundness::edges(double radius) const {
  const double share = std::clamp(1 - tolerance / radius, -1.0, 1.0);
  const double half = std::acos(share);  // of the angle that an edge spans
  const double wanted = half > 0 ? std::numbers::pi / half : most;
  std::uint32_t count = least;
  while (count < most && count < wanted) count = count % 3 == 0 ? count / 3 * 4 : count / 2 * 3;
  return count;
}

std::uint32_t parts_of_edge(std::uint32_t edges) {
  return std::max(1U, (edges + 4) / 5);
}

Quad face(const Box& box, std::size_t axis, bool upper) {
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  // Each corner is the same sum in all its three faces, so that they meet to the last bit.
  const auto corner = [&](bool at_u, bool at_v) {
    std::array<bool, 3> at{};
    at[axis] = upper;
    at[u] = at_u;
    at[v] = at_v;
    Vec3d sum = box.corner;
    for (std::size_t i = 0; i < 3; ++i)
      if (at[i]) sum = vec::add(sum, box.edges[i]);
    return sum;
  };
  Quad quad{{corner(false, false), corner(true, false), corner(true, true), corner(false, true)}};
  if (!upper) std::swap(quad.corners[1], quad.corners[3]);
  return quad;
}

double ShapeMesh::area() const {
  double sum = 0;
  for (const Triangle& triangle : triangles) {
    const Vec3d& a = positions[triangle.position[0]];
    sum += 0.5 * vec::length(vec::cross(vec::subtract(positions[triangle.position[1]], a),
                                        vec::subtract(positions[triangle.position[2]], a)));
  }
  return sum;
}

void ShapeMesh::flip() {
  for (Triangle& triangle : triangles) {
    std::swap(triangle.position[1], triangle.position[2]);
    std::swap(triangle.normal[1], triangle.normal[2]);
  }
  for (Vec3d& normal : normals) normal = vec::scale(normal, -1);
}

ShapeMesh tessellated(const Shape& shape, const Roundness& roundness) {
  return std::visit(Tessellation(roundness), shape);
}

std::array<Vec3d, 2> across(const Vec3d& axis) {
  std::size_t least = 0;
  for (std::size_t i = 1; i < 3; ++i)
    if (std::abs(axis[i]) < std::abs(axis[least])) least = i;
  Vec3d aside{0, 0, 0};
  aside[least] = 1;
  Vec3d first = vec::unit(vec::cross(aside, axis));
  // Of the two ways that are left, the one that does not turn with the axis.
  for (std::size_t i = 0; i < 3; ++i) {
    if (first[i] == 0) continue;
    if (first[i] < 0) first = vec::scale(first, -1);
    break;
  }
  return {first, vec::cross(axis, first)};
}

}  // namespace torolux
