// SPDX-License-Identifier: MIT
// A point is taken away where just two edges of any border meet, in one line: by Douglas and Peucker's rule, so that
// many small bends do not add up.
#include "host_tools/mesh/region_borders.hpp"

#include <algorithm>
#include <map>

#include "host_tools/scene/flat_surfaces.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// From the line between its neighbours, scene sizes: a fraction of what counts as one plane.
constexpr double kStraight = kSamePlane / 4;

/// How far a point lies from the line, and where along it (0: at a, 1: at b).
std::pair<double, double> place_on(const Vec3d& a, const Vec3d& b, const Vec3d& point) {
  const Vec3d way = vec::subtract(b, a);
  const double square = vec::dot(way, way);
  const Vec3d from = vec::subtract(point, a);
  if (!(square > 0)) return {vec::length(from), 0};
  const double along = vec::dot(from, way) / square;
  return {vec::length(vec::subtract(from, vec::scale(way, along))), along};
}

}  // namespace

RegionBorders::RegionBorders(const Scene& scene, const FlatRegions& regions, const std::vector<bool>& frozen)
    : scene_(scene),
      regions_(regions),
      frozen_(frozen),
      borders_(regions.all.size()),
      neighbours_(scene.positions.size()),
      stays_(scene.positions.size(), false),
      taken_(scene.positions.size(), false),
      needless_(regions.all.size(), false) {
  for (std::uint32_t region = 0; region < borders_.size(); ++region) collect(region);
  for (auto& list : neighbours_) {
    std::ranges::sort(list);
    list.erase(std::unique(list.begin(), list.end()), list.end());
  }
  straighten();
  join_edges();
}

/// Edges whose other side is another region, or none.
void RegionBorders::collect(std::uint32_t region) {
  std::vector<Edge> all;
  for (const std::uint32_t t : regions_.all[region].triangles) {
    const auto& p = scene_.triangles[t].position;
    for (std::size_t i = 0; i < 3; ++i) all.emplace_back(p[i], p[(i + 1) % 3]);
  }
  std::ranges::sort(all);
  std::vector<std::uint32_t> on_border;
  for (const auto& [a, b] : all) {
    if (std::ranges::binary_search(all, Edge{b, a})) continue;
    borders_[region].emplace_back(a, b);
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
    on_border.push_back(a);  // ascending, as `all` is
    if (frozen_[region]) stays_[a] = stays_[b] = true;
  }
  if (frozen_[region] || on_border.size() == all.size()) return;
  for (const auto& [a, b] : all)
    if (!std::ranges::binary_search(on_border, a)) needless_[region] = true;
}

void RegionBorders::straighten() {
  const auto count = static_cast<std::uint32_t>(neighbours_.size());
  for (std::uint32_t p = 0; p < count; ++p)
    if (neighbours_[p].size() != 2) stays_[p] = true;
  std::vector<bool> seen(count, false);
  for (std::uint32_t p = 0; p < count; ++p) {
    if (!stays_[p]) continue;
    for (const std::uint32_t next : neighbours_[p]) {
      if (stays_[next] || seen[next]) continue;
      const std::vector<std::uint32_t> chain = chain_from(p, next);
      for (const std::uint32_t other : chain) seen[other] = true;
      straighten_chain(chain);
    }
  }
  for (std::uint32_t p = 0; p < count; ++p) {  // loops without a point that stays
    if (stays_[p] || seen[p]) continue;
    // What lies farthest from any point is a corner.
    const std::uint32_t corner = farthest_from(p, chain_from(p, neighbours_[p][0]));
    const auto chain = chain_from(corner, neighbours_[corner][0]);
    const auto opposite = std::ranges::find(chain, farthest_from(corner, chain));
    for (const std::uint32_t other : chain) seen[other] = true;
    straighten_chain({chain.begin(), opposite + 1});
    straighten_chain({opposite, chain.end()});
  }
}

std::uint32_t RegionBorders::farthest_from(std::uint32_t point, std::span<const std::uint32_t> among) const {
  return *std::ranges::max_element(among, {}, [&](std::uint32_t other) {
    return vec::length(vec::subtract(scene_.positions[other], scene_.positions[point]));
  });
}

/// Up to the next point that stays, or back to the first one.
std::vector<std::uint32_t> RegionBorders::chain_from(std::uint32_t begin, std::uint32_t next) const {
  std::vector<std::uint32_t> chain{begin, next};
  while (!stays_[chain.back()] && chain.back() != begin) {
    const auto& beside = neighbours_[chain.back()];
    chain.push_back(beside[0] == chain[chain.size() - 2] ? beside[1] : beside[0]);
  }
  return chain;
}

void RegionBorders::straighten_chain(std::span<const std::uint32_t> chain) {
  if (chain.size() < 3) return;
  const Vec3d& first = scene_.positions[chain.front()];
  const Vec3d& last = scene_.positions[chain.back()];
  std::size_t farthest = 1;
  double distance = -1;
  bool in_order = true;
  double before = 0;
  for (std::size_t i = 1; i + 1 < chain.size(); ++i) {
    const auto [away, along] = place_on(first, last, scene_.positions[chain[i]]);
    if (away > distance) {
      distance = away;
      farthest = i;
    }
    in_order = in_order && along > before && along < 1;
    before = along;
  }
  if (in_order && distance <= kStraight) {
    for (std::size_t i = 1; i + 1 < chain.size(); ++i) taken_[chain[i]] = true;
    return;
  }
  straighten_chain(chain.subspan(0, farthest + 1));
  straighten_chain(chain.subspan(farthest));
}

/// What is left between points that are not taken away.
void RegionBorders::join_edges() {
  for (std::uint32_t region = 0; region < borders_.size(); ++region) {
    std::map<std::uint32_t, std::uint32_t> onward;  // from points that are taken away
    for (const auto& [a, b] : borders_[region])
      if (taken_[a]) onward[a] = b;
    if (!onward.empty()) needless_[region] = true;
    std::vector<Edge> joined;
    for (auto [a, b] : borders_[region]) {
      if (taken_[a]) continue;
      while (taken_[b]) b = onward.at(b);
      joined.emplace_back(a, b);
    }
    borders_[region] = std::move(joined);
  }
}

}  // namespace torolux
