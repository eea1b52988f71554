// SPDX-License-Identifier: MIT
// Borders of flat regions: which of their points are corners and which lie on a straight line between two others.
// Regions that share an edge see the same points on it, so no gap opens between them.
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "host_tools/mesh/flat_regions.hpp"

namespace torolux {

class RegionBorders {
 public:
  /// Points of frozen regions' borders (by region) all stay.
  RegionBorders(const Scene& scene, const FlatRegions& regions, const std::vector<bool>& frozen);

  /// The edges around a region as they are now, from position to position, with the region on their left.
  std::span<const std::pair<std::uint32_t, std::uint32_t>> around(std::uint32_t region) const {
    return borders_[region];
  }
  /// Whether a point of a region's triangles is none of its border, or has been taken from it.
  bool has_needless_points(std::uint32_t region) const { return needless_[region]; }

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;

  void collect(std::uint32_t region);
  void straighten();
  std::vector<std::uint32_t> chain_from(std::uint32_t begin, std::uint32_t next) const;
  std::uint32_t farthest_from(std::uint32_t point, std::span<const std::uint32_t> among) const;
  void straighten_chain(std::span<const std::uint32_t> chain);
  void join_edges();

  const Scene& scene_;
  const FlatRegions& regions_;
  const std::vector<bool>& frozen_;
  std::vector<std::vector<Edge>> borders_;              // by region, directed
  std::vector<std::vector<std::uint32_t>> neighbours_;  // by position, along borders, ascending
  std::vector<bool> stays_, taken_;                     // by position
  std::vector<bool> needless_;                          // by region
};

}  // namespace torolux
