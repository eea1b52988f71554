// SPDX-License-Identifier: MIT
// Borders of flat regions: which of their points are corners and which lie on a straight line between two others, and
// where an edge is halved. Regions that share an edge see the same points on it, so no gap opens between them.
#pragma once

#include <map>
#include <span>
#include <utility>
#include <vector>

#include "host_tools/mesh/flat_regions.hpp"

namespace torolux {

class RegionBorders {
 public:
  /// Points of frozen regions' borders (by region) all stay, and their edges stay whole. Edges up to `short_edge` are
  /// never halved, and not kept for that.
  RegionBorders(const Scene& scene, const FlatRegions& regions, const std::vector<bool>& frozen, double short_edge);

  /// The edges around a region as they are now, from position to position, with the region on their left.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> around(std::uint32_t region) const;
  /// Whether a point of a region's triangles is none of its border, or has been taken from it.
  bool has_needless_points(std::uint32_t region) const;

  /// False: it is short, or a frozen region has it.
  bool may_halve(std::uint32_t a, std::uint32_t b) const;
  /// middle: a new position, that of its middle.
  void halve(std::uint32_t a, std::uint32_t b, std::uint32_t middle);
  /// Regions with this edge, or the one of which it is a part, on their border.
  std::vector<std::uint32_t> regions_at(std::uint32_t a, std::uint32_t b) const;

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;  // low, high
  static Edge edge(std::uint32_t a, std::uint32_t b) { return a < b ? Edge{a, b} : Edge{b, a}; }

  double length_of(std::uint32_t a, std::uint32_t b) const;
  void collect(std::uint32_t region);
  void straighten();
  std::vector<std::uint32_t> chain_from(std::uint32_t begin, std::uint32_t next) const;
  std::uint32_t farthest_from(std::uint32_t point, std::span<const std::uint32_t> among) const;
  void straighten_chain(std::span<const std::uint32_t> chain);
  void join_edges();
  void add_halves(std::uint32_t a, std::uint32_t b, std::vector<Edge>& edges) const;

  const Scene& scene_;
  const FlatRegions& regions_;
  const std::vector<bool>& frozen_;
  double short_edge_;
  std::vector<std::vector<Edge>> borders_;              // by region, directed
  std::vector<std::vector<std::uint32_t>> neighbours_;  // by position, along borders, ascending
  std::vector<bool> stays_, taken_;                     // by position
  std::vector<bool> needless_;                          // by region
  std::map<Edge, std::vector<std::uint32_t>> regions_at_;
  std::map<Edge, std::uint32_t> middle_;
  std::map<Edge, Edge> half_of_;
};

}  // namespace torolux
