// SPDX-License-Identifier: MIT
// Round by round, one edge of a triangle in each, until no corner lies within an edge. Corners near an edge are found
// in lists sorted along each axis.
#include "host_tools/mesh/corners_on_edges.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>

#include "host_tools/mesh/edges.hpp"
#include "host_tools/mesh/flat_regions.hpp"
#include "host_tools/scene/flat_surfaces.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// From an edge's line, scene sizes: as borders of regions have it.
constexpr double kOnEdge = kSamePlane / 4;
/// Corners that are compared with edges, in all: a second's work.
constexpr std::size_t kMostCompared = 50'000'000;

/// An edge that no other triangle has.
struct FreeEdge {
  std::uint32_t triangle, edge;
  std::array<std::uint32_t, 2> end;  ///< positions
};

class Splitter {
 public:
  explicit Splitter(Scene& scene) : scene_(scene) {
    vec::Box box;
    for (const Vec3d& point : scene.positions) box.include(point);
    size_ = vec::largest(box.extent());
  }

  void run() {
    while (split_once()) {
    }
  }

 private:
  /// Whether there was anything to split.
  bool split_once() {
    collect();
    std::vector<std::uint32_t> edge_of(scene_.triangles.size(), kNone);
    std::vector<std::vector<std::uint32_t>> corners;  // within that edge, from its beginning on
    for (std::uint32_t e = 0; e < edges_.size(); ++e) {
      if (edge_of[edges_[e].triangle] != kNone) continue;
      std::vector<std::uint32_t> within = corners_within(edges_[e]);
      if (within.empty()) continue;
      edge_of[edges_[e].triangle] = static_cast<std::uint32_t>(corners.size());
      corners.push_back(std::move(within));
      corners.back().push_back(edges_[e].edge);
    }
    if (corners.empty()) return false;
    std::vector<SceneTriangle> triangles;
    for (std::uint32_t t = 0; t < edge_of.size(); ++t) {
      const SceneTriangle whole = scene_.triangles[t];
      if (edge_of[t] == kNone) {
        triangles.push_back(whole);
        continue;
      }
      const std::vector<std::uint32_t>& list = corners[edge_of[t]];
      add_fan(whole, list.back(), std::span(list).first(list.size() - 1), triangles);
    }
    scene_.triangles = std::move(triangles);
    return true;
  }

  void add_fan(const SceneTriangle& whole, std::uint32_t edge, std::span<const std::uint32_t> within,
               std::vector<SceneTriangle>& triangles) {
    const std::uint32_t opposite = whole.position[(edge + 2U) % 3U];
    std::uint32_t from = whole.position[edge];
    const auto add = [&](std::uint32_t to) {
      triangles.push_back(part_of(scene_, whole, {from, to, opposite}));
      from = to;
    };
    for (const std::uint32_t corner : within) add(corner);
    add(whole.position[(edge + 1U) % 3U]);
  }

  /// All free edges of plain triangles, the longest first, and their ends along each axis.
  void collect() {
    std::vector<std::array<std::uint32_t, 3>> corners;
    for (const SceneTriangle& t : scene_.triangles) corners.push_back(t.position);
    edges_.clear();
    for_each_edge(edge_uses(corners), [&](std::span<const EdgeUse> uses) {
      const SceneTriangle& t = scene_.triangles[uses[0].triangle];
      if (uses.size() != 1 || !is_plain(scene_, t)) return;
      const std::uint32_t edge = uses[0].edge;
      edges_.push_back({uses[0].triangle, edge, {t.position[edge], t.position[(edge + 1U) % 3U]}});
    });
    std::ranges::stable_sort(edges_, std::ranges::greater{}, [&](const FreeEdge& edge) { return length(edge); });
    for (std::size_t axis = 0; axis < 3; ++axis) {
      ends_[axis].clear();
      for (std::uint32_t e = 0; e < edges_.size(); ++e)
        for (const std::uint32_t p : edges_[e].end) ends_[axis].push_back({scene_.positions[p][axis], {e, p}});
      std::ranges::sort(ends_[axis]);
    }
  }

  double length(const FreeEdge& edge) const {
    return vec::length(vec::subtract(scene_.positions[edge.end[1]], scene_.positions[edge.end[0]]));
  }

  /// Ends of edges that run back along this one, in the order in which they lie on it.
  std::vector<std::uint32_t> corners_within(const FreeEdge& edge) {
    const Vec3d& a = scene_.positions[edge.end[0]];
    const Vec3d way = vec::subtract(scene_.positions[edge.end[1]], a);
    const double long_is = vec::length(way);
    const Vec3d direction = vec::scale(way, 1 / long_is);
    std::vector<std::pair<double, std::uint32_t>> found;
    for (const End& end : nearest_list(edge)) {
      const auto [other, corner] = end.second;
      const FreeEdge& beside = edges_[other];
      const Vec3d from = vec::subtract(scene_.positions[corner], a);
      const double along = vec::dot(from, direction);
      if (along <= tolerance() || along >= long_is - tolerance() || !on_line(from, direction)) continue;
      const std::uint32_t far = beside.end[0] == corner ? beside.end[1] : beside.end[0];
      const Vec3d back = vec::subtract(scene_.positions[beside.end[1]], scene_.positions[beside.end[0]]);
      if (vec::dot(back, direction) >= 0 || !on_line(vec::subtract(scene_.positions[far], a), direction)) continue;
      if (continues(scene_, scene_.triangles[beside.triangle], scene_.triangles[edge.triangle], size_))
        found.emplace_back(along, corner);
    }
    std::ranges::sort(found);
    std::vector<std::uint32_t> corners;
    for (const auto& [along, corner] : found)
      if (corners.empty() || corners.back() != corner) corners.push_back(corner);
    return corners;
  }

  bool on_line(const Vec3d& from, const Vec3d& direction) const {
    return vec::length(vec::subtract(from, vec::scale(direction, vec::dot(from, direction)))) <= tolerance();
  }

  using End = std::pair<double, std::pair<std::uint32_t, std::uint32_t>>;  // place, (number of the edge, position)

  /// Ends between those of the edge, along the axis where they are fewest. None, when enough has been compared.
  std::span<const End> nearest_list(const FreeEdge& edge) {
    std::span<const End> fewest;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] = std::minmax(scene_.positions[edge.end[0]][axis], scene_.positions[edge.end[1]][axis]);
      const auto begin = std::ranges::lower_bound(ends_[axis], low - tolerance(), {}, &End::first);
      const auto end = std::ranges::upper_bound(ends_[axis], high + tolerance(), {}, &End::first);
      const std::span<const End> list(begin, end);
      if (axis == 0 || list.size() < fewest.size()) fewest = list;
    }
    compared_ += fewest.size();
    return compared_ > kMostCompared ? std::span<const End>{} : fewest;
  }

  double tolerance() const { return kOnEdge * size_; }

  static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;
  Scene& scene_;
  double size_ = 0;
  std::vector<FreeEdge> edges_;
  std::array<std::vector<End>, 3> ends_;
  std::size_t compared_ = 0;
};

}  // namespace

void split_edges_at_corners(Scene& scene) {
  Splitter(scene).run();
}

}  // namespace torolux
