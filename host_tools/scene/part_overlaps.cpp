// SPDX-License-Identifier: MIT
// Cuts triangles by the convex outlines of what lies on them, and divides edges at the corners that come to lie there.
#include "host_tools/scene/part_overlaps.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "host_tools/scene/flat_surfaces.hpp"
#include "host_tools/scene/polygon_triangles.hpp"

namespace torolux {
namespace {

using Polygon = std::vector<std::uint32_t>;  ///< positions, in the winding of their triangle
using Edge = std::pair<std::uint32_t, std::uint32_t>;

/// Pieces of one triangle: beyond that it stays as it is.
constexpr std::size_t kMostPieces = 4096;
/// Emitters back to back are moved apart by this, of the scene's longest edge.
constexpr double kApart = 1e-5;

class Cutter {
 public:
  Cutter(Scene& scene, const std::vector<FlatSurface>& surfaces, const vec::Box& box)
      : scene_(scene), surfaces_(surfaces), low_(box.low), near_(kSamePlane * vec::largest(box.extent())) {}

  /// Of all surfaces that take part. Positions within near_ of one another are taken for one.
  void add_vertices(std::uint32_t surface) {
    for (const std::uint32_t t : surfaces_[surface].triangles)
      for (const std::uint32_t p : scene_.triangles[t].position) add_to_grid(p);
  }

  /// Takes from the lower surface's triangles what lies under the upper one. True: something was cut.
  bool cut(std::uint32_t upper, std::uint32_t lower) {
    bool changed = false;
    const std::vector<Polygon> outlines = convex_outlines(upper);
    for (const std::uint32_t t : surfaces_[lower].triangles) {
      const auto old = pieces_.find(t);
      std::vector<Polygon> pieces =
          old != pieces_.end()
              ? old->second
              : std::vector<Polygon>{{scene_.triangles[t].position.begin(), scene_.triangles[t].position.end()}};
      bool cut_here = false;
      for (const Polygon& outline : outlines) {
        std::vector<Polygon> left;
        for (const Polygon& piece : pieces)
          cut_here = take_away(piece, outline, surfaces_[lower].normal, left) || cut_here;
        pieces = std::move(left);
        if (pieces.size() > kMostPieces) break;
      }
      if (!cut_here || pieces.size() > kMostPieces) continue;
      pieces_[t] = std::move(pieces);
      changed = true;
    }
    return changed;
  }

  bool is_gone(std::uint32_t triangle) const {
    const auto pieces = pieces_.find(triangle);
    return pieces != pieces_.end() && pieces->second.empty();
  }

  /// Puts the pieces in their triangles' places. involved: surfaces that take part. Returns of which triangle each is.
  std::vector<std::uint32_t> finish(const std::vector<std::uint32_t>& involved) {
    divide_edges(involved);
    std::vector<SceneTriangle> triangles;
    std::vector<std::uint32_t> origin;
    for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
      const SceneTriangle whole = scene_.triangles[t];
      const auto cut = pieces_.find(t);
      std::vector<Polygon> pieces =
          cut != pieces_.end() ? cut->second : std::vector<Polygon>{{whole.position.begin(), whole.position.end()}};
      for (Polygon& piece : pieces) piece = divided(piece);
      if (cut == pieces_.end() && pieces[0].size() == 3) {
        triangles.push_back(whole);
      } else {
        for (const Polygon& piece : pieces) add_triangles(whole, piece, triangles);
      }
      origin.resize(triangles.size(), t);
    }
    scene_.triangles = std::move(triangles);
    return origin;
  }

 private:
  const Vec3d& at(std::uint32_t p) const { return scene_.positions[p]; }

  std::array<long, 3> cell_of(const Vec3d& point) const {
    const Vec3d from_low = vec::scale(vec::subtract(point, low_), 0.25 / near_);
    return {std::lround(from_low[0]), std::lround(from_low[1]), std::lround(from_low[2])};
  }

  void add_to_grid(std::uint32_t p) {
    auto& cell = grid_[cell_of(at(p))];
    if (std::ranges::find(cell, p) == cell.end()) cell.push_back(p);
  }

  /// The vertex at a point, an old one where there is one.
  std::uint32_t vertex_at(const Vec3d& point) {
    const auto middle = cell_of(point);
    for (long i = 0; i < 27; ++i) {
      const auto cell = grid_.find({middle[0] + i % 3 - 1, middle[1] + i / 3 % 3 - 1, middle[2] + i / 9 - 1});
      if (cell == grid_.end()) continue;
      for (const std::uint32_t p : cell->second)
        if (vec::length(vec::subtract(at(p), point)) <= near_) return p;
    }
    scene_.positions.push_back(point);
    const auto p = static_cast<std::uint32_t>(scene_.positions.size() - 1);
    add_to_grid(p);
    return p;
  }

  /// Counter-clockwise seen from the surface's front: its border where that is one convex loop, else its triangles.
  std::vector<Polygon> convex_outlines(std::uint32_t surface) const {
    std::map<Edge, int> edges;
    const FlatSurface& flat = surfaces_[surface];
    std::vector<Polygon> all;
    for (const std::uint32_t t : flat.triangles) {
      const auto& p = scene_.triangles[t].position;
      all.emplace_back(p.begin(), p.end());
      for (std::size_t i = 0; i < 3; ++i) ++edges[{p[i], p[(i + 1) % 3]}];
    }
    std::map<std::uint32_t, std::uint32_t> next;
    for (const auto& [edge, count] : edges) {
      if (edges.contains({edge.second, edge.first})) continue;
      if (count > 1 || !next.emplace(edge).second) return all;
    }
    if (next.empty()) return all;
    Polygon loop{next.begin()->first};
    while (next.contains(loop.back()) && next[loop.back()] != loop.front() && loop.size() <= next.size())
      loop.push_back(next[loop.back()]);
    if (loop.size() != next.size()) return all;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const Vec3d& b = at(loop[(i + 1) % loop.size()]);
      if (side_of(b, at(loop[i]), at(loop[(i + 2) % loop.size()]), flat.normal) > near_) return all;
    }
    return {loop};
  }

  /// How far a point lies to the left of a line from a to b, seen with the normal towards the eye.
  static double side_of(const Vec3d& point, const Vec3d& a, const Vec3d& b, const Vec3d& normal) {
    const Vec3d along = vec::subtract(b, a);
    const double length = vec::length(along);
    return length > 0 ? vec::dot(normal, vec::cross(along, vec::subtract(point, a))) / length : 0;
  }

  double area_of(const Polygon& polygon, const Vec3d& normal) const {
    Vec3d sum{0, 0, 0};
    for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
      sum = vec::add(sum, vec::cross(vec::subtract(at(polygon[i]), at(polygon[0])),
                                     vec::subtract(at(polygon[i + 1]), at(polygon[0]))));
    return 0.5 * std::abs(vec::dot(sum, normal));
  }

  /// Where an edge meets a line; the same for both ways to run through it.
  std::uint32_t crossing(std::uint32_t a, std::uint32_t b, double side_a, double side_b) {
    if (a > b) {
      std::swap(a, b);
      std::swap(side_a, side_b);
    }
    const Vec3d from = at(a);
    const Vec3d along = vec::subtract(at(b), from);
    return vertex_at(vec::add(from, vec::scale(along, side_a / (side_a - side_b))));
  }

  /// The parts of a convex polygon to the left and to the right of a line.
  std::pair<Polygon, Polygon> split(const Polygon& polygon, const Vec3d& a, const Vec3d& b, const Vec3d& normal) {
    std::pair<Polygon, Polygon> parts;
    const auto put = [](Polygon& part, std::uint32_t p) {
      if (part.empty() || part.back() != p) part.push_back(p);
    };
    std::vector<double> side;
    for (const std::uint32_t p : polygon) {
      const double distance = side_of(at(p), a, b, normal);
      side.push_back(std::abs(distance) <= near_ ? 0 : distance);
    }
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const std::size_t k = (i + 1) % polygon.size();
      if (side[i] >= 0) put(parts.first, polygon[i]);
      if (side[i] <= 0) put(parts.second, polygon[i]);
      if (side[i] * side[k] >= 0) continue;
      const std::uint32_t p = crossing(polygon[i], polygon[k], side[i], side[k]);
      put(parts.first, p);
      put(parts.second, p);
    }
    for (Polygon* part : {&parts.first, &parts.second}) {
      while (part->size() > 1 && part->back() == part->front()) part->pop_back();
      if (part->size() < 3 || area_of(*part, normal) <= near_ * near_) part->clear();
    }
    return parts;
  }

  /// Adds to `left` what of a convex piece lies outside of a convex outline. True: not all of it does.
  bool take_away(const Polygon& piece, const Polygon& outline, const Vec3d& normal, std::vector<Polygon>& left) {
    const Vec3d up = vec::scale(normal, runs_backwards(outline, normal) ? -1 : 1);
    if (parted_by(outline, piece, up) || parted_by(piece, outline, normal)) {
      left.push_back(piece);
      return false;
    }
    const std::size_t positions = scene_.positions.size();
    std::vector<Polygon> outside;
    Polygon inside = piece;
    for (std::size_t i = 0; i < outline.size() && !inside.empty(); ++i) {
      const Vec3d a = at(outline[i]);
      const Vec3d b = at(outline[(i + 1) % outline.size()]);
      auto [within, without] = split(inside, a, b, up);
      if (!without.empty()) outside.push_back(std::move(without));
      inside = std::move(within);
    }
    if (inside.empty()) {
      forget_from(positions);
      left.push_back(piece);
      return false;
    }
    left.insert(left.end(), outside.begin(), outside.end());
    return true;
  }

  /// Whether an edge of a polygon, counter-clockwise about `up`, has all of another on its outer side.
  bool parted_by(const Polygon& polygon, const Polygon& other, const Vec3d& up) const {
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3d& a = at(polygon[i]);
      const Vec3d& b = at(polygon[(i + 1) % polygon.size()]);
      if (std::ranges::all_of(other, [&](std::uint32_t p) { return side_of(at(p), a, b, up) <= near_; })) return true;
    }
    return false;
  }

  /// Takes back vertices that no piece came to have.
  void forget_from(std::size_t positions) {
    for (std::size_t p = positions; p < scene_.positions.size(); ++p)
      std::erase(grid_[cell_of(scene_.positions[p])], static_cast<std::uint32_t>(p));
    scene_.positions.resize(positions);
  }

  bool runs_backwards(const Polygon& outline, const Vec3d& normal) const {
    double doubled = 0;
    for (std::size_t i = 1; i + 1 < outline.size(); ++i)
      doubled += vec::dot(normal, vec::cross(vec::subtract(at(outline[i]), at(outline[0])),
                                             vec::subtract(at(outline[i + 1]), at(outline[0]))));
    return doubled < 0;
  }

  void divide_edges(const std::vector<std::uint32_t>& involved) {
    std::vector<Edge> edges;
    const auto add = [&](const Polygon& polygon) {
      for (std::size_t i = 0; i < polygon.size(); ++i)
        edges.push_back(std::minmax(polygon[i], polygon[(i + 1) % polygon.size()]));
    };
    for (const std::uint32_t s : involved) {
      for (const std::uint32_t t : surfaces_[s].triangles) {
        const auto& p = scene_.triangles[t].position;
        add({p.begin(), p.end()});
        if (const auto cut = pieces_.find(t); cut != pieces_.end()) std::ranges::for_each(cut->second, add);
      }
    }
    std::ranges::sort(edges);
    edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
    std::vector<std::pair<double, std::uint32_t>> by_x;
    for (const auto& [cell, members] : grid_)
      for (const std::uint32_t p : members) by_x.emplace_back(at(p)[0], p);
    std::ranges::sort(by_x);
    for (const Edge& edge : edges) divide(edge, by_x);
  }

  void divide(const Edge& edge, const std::vector<std::pair<double, std::uint32_t>>& by_x) {
    const Vec3d a = at(edge.first);
    const Vec3d along = vec::subtract(at(edge.second), a);
    const double length = vec::length(along);
    std::vector<std::pair<double, std::uint32_t>> on;
    const double low = std::min(a[0], at(edge.second)[0]) - near_;
    const double high = std::max(a[0], at(edge.second)[0]) + near_;
    for (auto i = std::ranges::lower_bound(by_x, std::pair(low, std::uint32_t{0})); i != by_x.end() && i->first <= high;
         ++i) {
      if (i->second == edge.first || i->second == edge.second) continue;
      const Vec3d to = vec::subtract(at(i->second), a);
      const double way = vec::dot(to, along) / length;
      if (way <= near_ || way >= length - near_) continue;
      if (vec::length(vec::cross(along, to)) / length <= near_) on.emplace_back(way, i->second);
    }
    if (on.empty()) return;
    std::ranges::sort(on);
    for (const auto& [way, p] : on) points_on_[edge].push_back(p);
  }

  Polygon divided(const Polygon& polygon) const {
    Polygon result;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const std::uint32_t a = polygon[i];
      const std::uint32_t b = polygon[(i + 1) % polygon.size()];
      result.push_back(a);
      const auto points = points_on_.find(std::minmax(a, b));
      if (points == points_on_.end()) continue;
      if (a < b)
        result.insert(result.end(), points->second.begin(), points->second.end());
      else
        result.insert(result.end(), points->second.rbegin(), points->second.rend());
    }
    return result;
  }

  void add_triangles(const SceneTriangle& whole, const Polygon& piece, std::vector<SceneTriangle>& triangles) {
    std::vector<Vec3d> corners;
    for (const std::uint32_t p : piece) corners.push_back(at(p));
    for (const auto& corner : cut_polygon(corners).triangles) {
      SceneTriangle part = whole;
      for (std::size_t i = 0; i < 3; ++i) part.position[i] = piece[corner[i]];
      if (whole.texture_points != kNoImage)
        part.texture_points = static_cast<std::uint32_t>(scene_.texture_points.size());
      for (std::size_t i = 0; i < 3; ++i) mix_corner(whole, part, i);
      triangles.push_back(part);
    }
  }

  /// Normal and texture point of a part's corner, from those of the whole.
  void mix_corner(const SceneTriangle& whole, SceneTriangle& part, std::size_t corner) {
    const std::array<Vec3d, 3> c{at(whole.position[0]), at(whole.position[1]), at(whole.position[2])};
    const Vec3d across = vec::cross(vec::subtract(c[1], c[0]), vec::subtract(c[2], c[0]));
    const Vec3d& p = at(part.position[corner]);
    Vec3d weight{};
    for (std::size_t k = 0; k < 3; ++k)
      weight[k] = vec::dot(across, vec::cross(vec::subtract(c[(k + 1) % 3], p), vec::subtract(c[(k + 2) % 3], p))) /
                  vec::dot(across, across);
    if (whole.texture_points != kNoImage) {
      std::array<double, 2> point{0, 0};
      for (std::uint32_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 2; ++axis)
          point[axis] += weight[k] * scene_.texture_points[whole.texture_points + k][axis];
      scene_.texture_points.push_back(point);
    }
    if (whole.normal[0] == kNoNormal || whole.normal[1] == kNoNormal || whole.normal[2] == kNoNormal) return;
    Vec3d normal{0, 0, 0};
    for (std::size_t k = 0; k < 3; ++k)
      normal = vec::add(normal, vec::scale(scene_.normals[whole.normal[k]], weight[k]));
    part.normal[corner] = static_cast<std::uint32_t>(scene_.normals.size());
    scene_.normals.push_back(vec::unit(normal));
  }

  Scene& scene_;
  const std::vector<FlatSurface>& surfaces_;
  Vec3d low_;
  double near_;  ///< [scene units]
  std::map<std::array<long, 3>, std::vector<std::uint32_t>> grid_;
  std::map<std::uint32_t, std::vector<Polygon>> pieces_;  ///< of triangles that are cut
  std::map<Edge, Polygon> points_on_;
};

bool back_to_back(const FlatSurface& a, const FlatSurface& b) {
  return a.emits && b.emits && vec::dot(a.normal, b.normal) < 0;
}

/// Moves triangles by steps that are given for the triangles they come from; what does not move keeps its corners.
void move_apart(Scene& scene, const std::vector<std::uint32_t>& origin, const std::map<std::uint32_t, Vec3d>& steps) {
  std::map<std::pair<std::uint32_t, Vec3d>, std::uint32_t> moved;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    const auto step = steps.find(origin[t]);
    if (step == steps.end()) continue;
    for (std::uint32_t& p : scene.triangles[t].position) {
      const auto [entry, fresh] =
          moved.emplace(std::pair(p, step->second), static_cast<std::uint32_t>(scene.positions.size()));
      if (fresh) scene.positions.push_back(vec::add(scene.positions[p], step->second));
      p = entry->second;
    }
  }
}

}  // namespace

void part_overlaps(Scene& scene, Notices& notices, const Place& place) {
  vec::Box box;
  for (const Vec3d& p : scene.positions) box.include(p);
  const double size = vec::largest(box.extent());
  const std::vector<FlatSurface> surfaces = flat_surfaces(scene, size);
  const auto pairs = pairs_in_one_plane(scene, surfaces, size);
  if (pairs.empty()) return;
  Cutter cutter(scene, surfaces, box);
  std::vector<std::uint32_t> involved;
  for (const auto& [upper, lower] : pairs) involved.insert(involved.end(), {upper, lower});
  std::ranges::sort(involved);
  involved.erase(std::unique(involved.begin(), involved.end()), involved.end());
  for (const std::uint32_t s : involved) cutter.add_vertices(s);
  const auto name = [&](std::uint32_t s) {
    return "'" + scene.materials[scene.triangles[surfaces[s].triangles[0]].material].name + "'";
  };
  bool any = false;
  std::map<std::uint32_t, Vec3d> steps;
  for (const auto& [upper, lower] : pairs) {
    const auto& under = surfaces[lower].triangles;
    if (back_to_back(surfaces[upper], surfaces[lower])) {
      notices.note("two emitters lie back to back in one plane: moved apart a little", place, name(lower));
      for (const std::uint32_t s : {upper, lower})
        for (const std::uint32_t t : surfaces[s].triangles)
          steps.emplace(t, vec::scale(surfaces[s].normal, kApart * size));
      continue;
    }
    if (!cutter.cut(upper, lower)) continue;
    any = true;
    if (std::ranges::all_of(under, [&](std::uint32_t t) { return cutter.is_gone(t); }) &&
        vec::dot(surfaces[upper].normal, surfaces[lower].normal) < 0)
      notices.note("a surface that stands twice, its fronts both ways, is one with two sides", place, name(upper));
    else
      notices.note("surfaces overlap in one plane: emitters lie on top, then the smaller one", place,
                   name(upper) + " on " + name(lower));
  }
  std::vector<std::uint32_t> origin(scene.triangles.size());
  std::iota(origin.begin(), origin.end(), std::uint32_t{0});
  if (any) origin = cutter.finish(involved);
  move_apart(scene, origin, steps);
}

}  // namespace torolux
