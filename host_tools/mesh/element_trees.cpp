// SPDX-License-Identifier: MIT
// Each triangle's tree grows to its level, deeper at walls, under what hangs over it, and at splits. Then elements
// beside much smaller ones are cut, until there are none.
#include "host_tools/mesh/element_trees.hpp"

#include <algorithm>
#include <unordered_set>

#include "firmware/protocol/triangle_grid.hpp"

namespace torolux {
namespace {

using protocol::kMostLevels;

GridPoint middle(const GridPoint& a, const GridPoint& b) {
  return {(a.i + b.i) / 2, (a.j + b.j) / 2};
}

/// What a wall crosses is cut so many times more than its length asks for,
constexpr std::uint32_t kWallLevels = 2;
/// and so many times what lies close under another surface.
constexpr std::uint32_t kOverhungLevels = 1;

/// Grows the tree of one triangle.
struct Grower {
  const Mesh& mesh;
  const std::vector<Split>& splits;
  std::uint32_t triangle;
  std::uint32_t base;
  std::vector<std::uint32_t>& leaves;

  void grow(std::uint32_t code, std::uint32_t level) {
    if (!is_cut(code, level)) {
      leaves.push_back(code);
      return;
    }
    for (std::uint32_t child = 0; child < 4; ++child) grow(code << 2U | child, level + 1);
  }

 private:
  bool is_cut(std::uint32_t code, std::uint32_t level) const {
    if (level < base) return true;
    if (level == kMostLevels) return false;
    return (level < base + kWallLevels && mesh.walls.cross(triangle, code)) ||
           (level < base + kOverhungLevels && is_close_under_another(code)) ||
           std::binary_search(splits.begin(), splits.end(), Split{triangle, code});
  }
  /// What is no longer than an element as it is stays: of a heap of small things each would be cut.
  bool is_close_under_another(std::uint32_t code) const {
    return base > 0 && mesh.clearance.is_overhung(triangle, grid_corners(mesh.triangles[triangle], code));
  }
};

/// The corners of all elements.
class Vertices {
 public:
  Vertices(const Mesh& mesh, const Leaves& leaves) : mesh_(mesh) {
    for (std::uint32_t t = 0; t < leaves.size(); ++t) {
      for (const std::uint32_t code : leaves[t]) {
        for (const GridPoint& corner : grid_points(code)) keys_.insert(vertex_key(mesh, t, corner));
      }
    }
  }

  /// Whether a neighbour at one of its edges is less than half as large.
  bool too_large(std::uint32_t triangle, std::uint32_t code) const {
    if (protocol::level_of_code(code) + 2 > kMostLevels) return false;
    const auto corner = grid_points(code);
    for (std::size_t e = 0; e < 3; ++e) {
      const GridPoint& from = corner[e];
      const GridPoint& to = corner[(e + 1) % 3];
      const GridPoint mid = middle(from, to);
      if (!has(triangle, mid)) continue;
      if (has(triangle, middle(from, mid)) || has(triangle, middle(mid, to))) return true;
    }
    return false;
  }

 private:
  bool has(std::uint32_t triangle, const GridPoint& point) const {
    return keys_.contains(vertex_key(mesh_, triangle, point));
  }

  const Mesh& mesh_;
  std::unordered_set<std::uint64_t> keys_;
};

/// True: something was cut.
bool balance_once(const Mesh& mesh, Leaves& leaves) {
  const Vertices vertices(mesh, leaves);
  bool any = false;
  for (std::uint32_t t = 0; t < leaves.size(); ++t) {
    std::vector<std::uint32_t> next;
    for (const std::uint32_t code : leaves[t]) {
      if (!vertices.too_large(t, code)) {
        next.push_back(code);
        continue;
      }
      for (std::uint32_t child = 0; child < 4; ++child) next.push_back(code << 2U | child);
    }
    any = any || next.size() != leaves[t].size();
    leaves[t] = std::move(next);
  }
  return any;
}

}  // namespace

Leaves element_leaves(const Mesh& mesh, const std::vector<int>& base_level, const std::vector<Split>& splits) {
  Leaves leaves(mesh.triangles.size());
  for (std::uint32_t t = 0; t < leaves.size(); ++t) {
    if (base_level[t] < 0) continue;
    Grower{mesh, splits, t, static_cast<std::uint32_t>(base_level[t]), leaves[t]}.grow(1, 0);
  }
  while (balance_once(mesh, leaves)) {
  }
  return leaves;
}

}  // namespace torolux
