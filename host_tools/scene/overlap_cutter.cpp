// SPDX-License-Identifier: MIT
// Cuts triangles by the convex outlines of what lies on them, and divides edges at the corners that come to lie there.
#include "host_tools/scene/overlap_cutter.hpp"

#include <algorithm>

#include "host_tools/scene/point_tree.hpp"
#include "host_tools/scene/polygon_triangles.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Of one triangle: beyond that it stays as it is.
constexpr std::size_t kMostPieces = 4096;
/// Of all cuts, and of all that is divided, counted as comparisons of a corner with an edge: some seconds.
constexpr std::size_t kMostWork = 500'000'000;
/// What else costs, in such comparisons: a piece that is cut up, a triangle whose border is looked for.
constexpr std::size_t kCutWork = 500;
constexpr std::size_t kBorderWork = 50;
/// Corners on an edge: each with each, since the polygon that has them is cut into triangles.
constexpr std::size_t kDivideWork = 10;

}  // namespace

OverlapCutter::OverlapCutter(Scene& scene, const std::vector<FlatSurface>& surfaces, const vec::Box& box)
    : scene_(scene),
      surfaces_(surfaces),
      near_(kSamePlane * vec::largest(box.extent())),
      vertices_(scene, box.low, near_),
      convex_cut_(scene, vertices_, near_),
      work_left_(kMostWork) {}

bool OverlapCutter::spend(std::size_t work) {
  work_left_ -= std::min(work, work_left_);
  return work_left_ > 0;
}

void OverlapCutter::add_vertices(std::uint32_t surface) {
  for (const std::uint32_t t : surfaces_[surface].triangles)
    for (const std::uint32_t p : scene_.triangles[t].position) vertices_.add(p);
}

std::vector<PositionPolygon> OverlapCutter::pieces_of(std::uint32_t triangle) const {
  const auto cut = pieces_.find(triangle);
  if (cut != pieces_.end()) return cut->second;
  const auto& whole = scene_.triangles[triangle].position;
  return {{whole.begin(), whole.end()}};
}

OverlapCutter::Found OverlapCutter::cut(std::uint32_t upper, std::uint32_t lower) {
  Found found = Found::nothing;
  if (!spend(kBorderWork * surfaces_[upper].triangles.size())) return Found::too_long;
  const std::vector<PositionPolygon> outlines = convex_outlines(upper);
  for (const std::uint32_t t : surfaces_[lower].triangles) {
    std::vector<PositionPolygon> pieces = pieces_of(t);
    bool cut_here = false;
    for (const PositionPolygon& outline : outlines) {
      std::vector<PositionPolygon> left;
      if (!spend(outline.size())) return Found::too_long;
      for (const PositionPolygon& piece : pieces) {
        const bool cut = convex_cut_.take_away(piece, outline, surfaces_[lower].normal, left);
        if (!spend(piece.size() * outline.size() + (cut ? kCutWork : 0))) return Found::too_long;
        cut_here = cut_here || cut;
      }
      pieces = std::move(left);
      if (pieces.size() > kMostPieces) break;
    }
    if (!cut_here) continue;
    if (pieces.size() > kMostPieces) {
      found = Found::too_many_pieces;
      continue;
    }
    pieces_[t] = std::move(pieces);
    if (found == Found::nothing) found = Found::cut;
  }
  return found;
}

bool OverlapCutter::covers(std::uint32_t upper, std::uint32_t lower) {
  const std::size_t positions = scene_.positions.size();
  std::map<std::uint32_t, std::vector<PositionPolygon>> before;
  for (const std::uint32_t t : surfaces_[lower].triangles)
    if (const auto pieces = pieces_.find(t); pieces != pieces_.end()) before.insert(*pieces);
  const bool all = cut(upper, lower) == Found::cut &&
                   std::ranges::all_of(surfaces_[lower].triangles, [this](std::uint32_t t) { return is_gone(t); });
  for (const std::uint32_t t : surfaces_[lower].triangles) pieces_.erase(t);
  pieces_.merge(before);
  vertices_.forget_from(positions);
  return all;
}

bool OverlapCutter::is_gone(std::uint32_t triangle) const {
  const auto pieces = pieces_.find(triangle);
  return pieces != pieces_.end() && pieces->second.empty();
}

std::vector<std::uint32_t> OverlapCutter::finish(const std::vector<std::uint32_t>& involved) {
  divide_edges(involved);
  std::vector<SceneTriangle> triangles;
  std::vector<std::uint32_t> origin;
  for (std::uint32_t t = 0; t < scene_.triangles.size(); ++t) {
    const SceneTriangle whole = scene_.triangles[t];
    const auto cut = pieces_.find(t);
    std::vector<PositionPolygon> pieces =
        cut != pieces_.end() ? cut->second
                             : std::vector<PositionPolygon>{{whole.position.begin(), whole.position.end()}};
    for (PositionPolygon& piece : pieces) piece = divided(piece);
    if (cut == pieces_.end() && pieces[0].size() == 3) {
      triangles.push_back(whole);
    } else {
      for (const PositionPolygon& piece : pieces) add_triangles(whole, piece, triangles);
    }
    origin.resize(triangles.size(), t);
  }
  scene_.triangles = std::move(triangles);
  return origin;
}

std::vector<PositionPolygon> OverlapCutter::convex_outlines(std::uint32_t surface) const {
  std::map<Edge, int> edges;
  const FlatSurface& flat = surfaces_[surface];
  std::vector<PositionPolygon> all;
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
  PositionPolygon loop{next.begin()->first};
  while (next.contains(loop.back()) && next[loop.back()] != loop.front() && loop.size() <= next.size())
    loop.push_back(next[loop.back()]);
  if (loop.size() != next.size()) return all;
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const Vec3d& b = at(loop[(i + 1) % loop.size()]);
    if (side_of(b, at(loop[i]), at(loop[(i + 2) % loop.size()]), flat.normal) > near_) return all;
  }
  return {loop};
}

void OverlapCutter::divide_edges(const std::vector<std::uint32_t>& involved) {
  std::vector<Edge> edges;
  const auto add = [&](const PositionPolygon& polygon) {
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
  const PointTree corners(scene_.positions, vertices_.all());
  std::vector<std::uint32_t> around;
  work_left_ = kMostWork;
  for (const Edge& edge : edges) {
    corners.find_near(at(edge.first), at(edge.second), near_, around);
    if (!spend(around.size())) {
      leaves_whole_ = true;
      return;
    }
    divide(edge, around);
  }
}

void OverlapCutter::divide(const Edge& edge, std::span<const std::uint32_t> around) {
  const Vec3d a = at(edge.first);
  const Vec3d along = vec::subtract(at(edge.second), a);
  const double length = vec::length(along);
  std::vector<std::pair<double, std::uint32_t>> on;
  for (const std::uint32_t p : around) {
    if (p == edge.first || p == edge.second) continue;
    const Vec3d to = vec::subtract(at(p), a);
    const double way = vec::dot(to, along) / length;
    if (way <= near_ || way >= length - near_) continue;
    if (vec::length(vec::cross(along, to)) / length <= near_) on.emplace_back(way, p);
  }
  if (on.empty()) return;
  const std::size_t work = kDivideWork * on.size() * on.size();
  if (work >= work_left_) {
    leaves_whole_ = true;
    return;
  }
  spend(work);
  std::ranges::sort(on);
  for (const auto& [way, p] : on) points_on_[edge].push_back(p);
}

PositionPolygon OverlapCutter::divided(const PositionPolygon& polygon) const {
  PositionPolygon result;
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

void OverlapCutter::add_triangles(const SceneTriangle& whole, const PositionPolygon& piece,
                                  std::vector<SceneTriangle>& triangles) {
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

void OverlapCutter::mix_corner(const SceneTriangle& whole, SceneTriangle& part, std::size_t corner) {
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
  for (std::size_t k = 0; k < 3; ++k) normal = vec::add(normal, vec::scale(scene_.normals[whole.normal[k]], weight[k]));
  part.normal[corner] = static_cast<std::uint32_t>(scene_.normals.size());
  scene_.normals.push_back(vec::unit(normal));
}

}  // namespace torolux
