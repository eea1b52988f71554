// SPDX-License-Identifier: MIT
// Surfaces in one plane in; the scene with triangles cut where others lie on them, and edges divided at the corners
// that come to lie there, out.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

#include "host_tools/scene/convex_cut.hpp"
#include "host_tools/scene/flat_surfaces.hpp"
#include "host_tools/scene/near_vertices.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

class OverlapCutter {
 public:
  enum class Found { nothing, cut, too_many_pieces, too_long };

  /// box: of the scene.
  OverlapCutter(Scene& scene, const std::vector<FlatSurface>& surfaces, const vec::Box& box);

  /// Of all surfaces that take part. Positions that lie in one place but for rounding are taken for one.
  void add_vertices(std::uint32_t surface);

  /// Takes from the lower surface's triangles what lies under the upper one. too_many_pieces: a triangle of more stays
  /// as it was, whatever became of the others. too_long: all cuts together have taken more work than a scene is worth;
  /// nothing is cut any more.
  Found cut(std::uint32_t upper, std::uint32_t lower);
  /// Whether that would leave nothing of it.
  bool covers(std::uint32_t upper, std::uint32_t lower);
  bool is_gone(std::uint32_t triangle) const;

  /// Puts the pieces in their triangles' places. involved: surfaces that take part. Returns of which triangle each is.
  std::vector<std::uint32_t> finish(const std::vector<std::uint32_t>& involved);
  /// Whether `finish` has left edges undivided on which more corners lie than a scene is worth.
  bool leaves_whole() const { return leaves_whole_; }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  const Vec3d& at(std::uint32_t p) const { return scene_.positions[p]; }
  std::vector<PositionPolygon> pieces_of(std::uint32_t triangle) const;
  /// False: there is none left.
  bool spend(std::size_t work);
  /// Counter-clockwise seen from the surface's front: its border where that is one convex loop, else its triangles.
  std::vector<PositionPolygon> convex_outlines(std::uint32_t surface) const;
  void divide_edges(const std::vector<std::uint32_t>& involved);
  /// around: all corners on the edge, and others.
  void divide(const Edge& edge, std::span<const std::uint32_t> around);
  PositionPolygon divided(const PositionPolygon& polygon) const;
  void add_triangles(const SceneTriangle& whole, const PositionPolygon& piece, std::vector<SceneTriangle>& triangles);
  /// Normal and texture point of a part's corner, from those of the whole.
  void mix_corner(const SceneTriangle& whole, SceneTriangle& part, std::size_t corner);

  Scene& scene_;
  const std::vector<FlatSurface>& surfaces_;
  double near_;  ///< [scene units]
  NearVertices vertices_;
  ConvexCut convex_cut_;
  std::map<std::uint32_t, std::vector<PositionPolygon>> pieces_;  ///< of triangles that are cut
  std::map<Edge, PositionPolygon> points_on_;
  std::size_t work_left_;  ///< comparisons of a corner with an edge
  bool leaves_whole_ = false;
};

}  // namespace torolux
