// SPDX-License-Identifier: MIT
// A sort by the two positions brings the uses of an edge together. Disjoint sets: a union-find with halved paths.
#include "host_tools/mesh/edges.hpp"

#include <algorithm>
#include <numeric>

namespace torolux {

std::vector<EdgeUse> edge_uses(std::span<const std::array<std::uint32_t, 3>> triangles) {
  std::vector<EdgeUse> uses;
  uses.reserve(triangles.size() * 3);
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::uint8_t e = 0; e < 3; ++e) {
      const std::uint32_t from = triangles[t][e];
      const std::uint32_t to = triangles[t][(e + 1U) % 3U];
      uses.push_back({std::min(from, to), std::max(from, to), t, e, from < to});
    }
  }
  std::sort(uses.begin(), uses.end());
  return uses;
}

DisjointSets::DisjointSets(std::size_t members) : parent_(members) {
  std::iota(parent_.begin(), parent_.end(), 0U);
}

std::uint32_t DisjointSets::root(std::uint32_t member) {
  while (parent_[member] != member) {
    parent_[member] = parent_[parent_[member]];
    member = parent_[member];
  }
  return member;
}

void DisjointSets::merge(std::uint32_t a, std::uint32_t b) {
  const std::uint32_t root_a = root(a);
  const std::uint32_t root_b = root(b);
  parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
}

}  // namespace torolux
