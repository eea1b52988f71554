// SPDX-License-Identifier: MIT
// Of each edge that may pass radiance on, ends and edge are joined in disjoint sets. Their roots are the names by which
// grid points of different triangles are found to be one vertex.
#include "host_tools/mesh/smooth_surfaces.hpp"

#include <algorithm>
#include <iterator>
#include <map>
#include <span>
#include <utility>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/edges.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/mesh/pierced.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

Vec3d unit_normal(const MeshTriangle& triangle) {
  const Vec3d corner = to_double(triangle.corner[0]);
  return vec::unit(vec::cross(vec::subtract(to_double(triangle.corner[1]), corner),
                              vec::subtract(to_double(triangle.corner[2]), corner)));
}

bool smooth_across(const Mesh& mesh, const std::vector<bool>& small, const EdgeUse& a, const EdgeUse& b) {
  const MeshTriangle& first = mesh.triangles[a.triangle];
  const MeshTriangle& second = mesh.triangles[b.triangle];
  const double least = small[a.triangle] && small[b.triangle] ? kSmoothCosineOfSmall : kSmoothCosine;
  return first.sides != 0 && first.sides == second.sides && first.material == second.material &&
         a.forward != b.forward && vec::dot(unit_normal(first), unit_normal(second)) > least;
}

Vec3d middle_of(const Mesh& mesh, const EdgeUse& use) {
  const auto& corner = mesh.triangles[use.triangle].corner;
  return vec::scale(vec::add(to_double(corner[use.edge]), to_double(corner[(use.edge + 1U) % 3U])), 0.5);
}

/// Both uses of an edge that two triangles share.
using SharedEdge = std::array<EdgeUse, 2>;

/// Where another surface passes through a smooth one of small triangles, that is parted, as large ones are by walls:
/// inside, where a teapot's spout ends in its body, it is dark. What is pierced goes with the larger part, of which
/// more is seen. By triangle: a number of its part.
class Parts {
 public:
  Parts(const Mesh& mesh, std::span<const SharedEdge> edges) : part_(mesh.triangles.size()) {
    std::vector<SmoothEdge> ways;
    ways.reserve(edges.size());
    for (const auto& [a, b] : edges) ways.push_back({{a.triangle, b.triangle}, middle_of(mesh, a)});
    const std::vector<bool> pierced = pierced_triangles(mesh, ways);
    if (std::ranges::find(pierced, true) == pierced.end()) return;  // all of one part
    for (const SharedEdge& edge : edges) {
      if (pierced[edge[0].triangle] || pierced[edge[1].triangle]) of_pierced_.push_back(edge);
    }
    DisjointSets whole(mesh.triangles.size());
    for (const auto& [a, b] : edges) {
      if (!pierced[a.triangle] && !pierced[b.triangle]) whole.merge(a.triangle, b.triangle);
    }
    area_.assign(mesh.triangles.size(), 0);
    for (std::uint32_t t = 0; t < part_.size(); ++t) {
      part_[t] = pierced[t] ? kNoNeighbour : whole.root(t);
      if (!pierced[t]) area_[part_[t]] += mesh.triangles[t].area;
    }
    while (join_neighbours()) {
    }
  }

  bool same(const SharedEdge& edge) const { return part_[edge[0].triangle] == part_[edge[1].triangle]; }

 private:
  /// Those that are pierced, and beside a part, become the largest's. False: there are none.
  bool join_neighbours() {
    std::map<std::uint32_t, std::uint32_t> joined;
    for (const auto& [a, b] : of_pierced_) {
      consider(a.triangle, b.triangle, joined);
      consider(b.triangle, a.triangle, joined);
    }
    for (const auto& [triangle, part] : joined) part_[triangle] = part;
    return !joined.empty();
  }
  void consider(std::uint32_t triangle, std::uint32_t beside, std::map<std::uint32_t, std::uint32_t>& joined) const {
    if (part_[triangle] != kNoNeighbour || part_[beside] == kNoNeighbour) return;
    const auto [at, is_new] = joined.try_emplace(triangle, part_[beside]);
    if (!is_new && area_[part_[beside]] > area_[at->second]) at->second = part_[beside];
  }

  std::vector<SharedEdge> of_pierced_;
  std::vector<std::uint32_t> part_;  // by triangle; kNoNeighbour: pierced, and beside no part
  std::vector<double> area_;         // by part
};

/// Edges across which radiance passes on.
std::vector<SharedEdge> smooth_edges(const Mesh& mesh, const std::vector<bool>& small, std::span<const EdgeUse> uses,
                                     Pierced pierced) {
  std::vector<SharedEdge> smooth;
  std::vector<SharedEdge> of_small;
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    // A third triangle at an edge is a wall that stands there: light on one side of it must not show on the other.
    if (edge.size() != 2 || !smooth_across(mesh, small, edge[0], edge[1])) return;
    const bool may_end = pierced == Pierced::ends && small[edge[0].triangle] && small[edge[1].triangle];
    (may_end ? of_small : smooth).push_back({edge[0], edge[1]});
  });
  const Parts parts(mesh, of_small);
  std::ranges::copy_if(of_small, std::back_inserter(smooth), [&](const SharedEdge& edge) { return parts.same(edge); });
  return smooth;
}

/// Corner of a use's triangle at the edge's lower position, then at its higher one.
std::array<std::uint32_t, 2> end_nodes(const EdgeUse& use) {
  const std::uint32_t from = 3 * use.triangle + use.edge;
  const std::uint32_t to = 3 * use.triangle + (use.edge + 1U) % 3U;
  return use.forward ? std::array{from, to} : std::array{to, from};
}

}  // namespace

SmoothSurfaces find_smooth_surfaces(const Mesh& mesh, const std::vector<bool>& small, Pierced pierced) {
  std::vector<std::array<std::uint32_t, 3>> positions;
  positions.reserve(mesh.triangles.size());
  for (const MeshTriangle& triangle : mesh.triangles) positions.push_back(triangle.position);
  const std::vector<EdgeUse> uses = edge_uses(positions);
  const std::size_t nodes = 3 * mesh.triangles.size();
  DisjointSets corners(nodes);
  DisjointSets edges(nodes);
  SmoothSurfaces surfaces;
  surfaces.neighbour.assign(mesh.triangles.size(), {kNoNeighbour, kNoNeighbour, kNoNeighbour});
  for (const SharedEdge& edge : smooth_edges(mesh, small, uses, pierced)) {
    edges.merge(3 * edge[0].triangle + edge[0].edge, 3 * edge[1].triangle + edge[1].edge);
    const auto ends = end_nodes(edge[0]);
    const auto other_ends = end_nodes(edge[1]);
    corners.merge(ends[0], other_ends[0]);
    corners.merge(ends[1], other_ends[1]);
    surfaces.neighbour[edge[0].triangle][edge[0].edge] = edge[1].triangle;
    surfaces.neighbour[edge[1].triangle][edge[1].edge] = edge[0].triangle;
  }
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    auto& corner_node = surfaces.corner_node.emplace_back();
    auto& edge_node = surfaces.edge_node.emplace_back();
    for (std::uint32_t i = 0; i < 3; ++i) {
      corner_node[i] = corners.root(3 * t + i);
      edge_node[i] = edges.root(3 * t + i);
    }
  }
  return surfaces;
}

// As protocol::grid_triangle_of, without the weight that follows from the others: this is asked very often.
std::array<GridPoint, 3> grid_points(std::uint32_t code) {
  constexpr std::uint32_t one = 1U << protocol::kMostLevels;
  const auto middle = [](const GridPoint& p, const GridPoint& q) {
    return GridPoint{(p.i + q.i) / 2, (p.j + q.j) / 2};
  };
  std::array<GridPoint, 3> points{{{0, 0}, {one, 0}, {0, one}}};
  const std::uint32_t path = protocol::path_of_code(code);
  for (std::uint32_t step = protocol::level_of_code(code); step-- > 0U;) {
    auto& [a, b, c] = points;
    const std::array<GridPoint, 3> opposite{middle(b, c), middle(c, a), middle(a, b)};
    const std::uint32_t child = path >> (2U * step) & 3U;
    const GridPoint kept = points[child % 3];
    points = opposite;
    if (child == 3) continue;
    points[child] = kept;
    std::swap(points[(child + 1) % 3], points[(child + 2) % 3]);
  }
  return points;
}

std::uint64_t vertex_key(const Mesh& mesh, std::uint32_t triangle, const GridPoint& point) {
  const auto [i, j] = point;
  constexpr std::uint32_t n = 1U << protocol::kMostLevels;
  constexpr std::uint64_t edge_kind = std::uint64_t{1} << 62U;
  constexpr std::uint64_t interior_kind = std::uint64_t{2} << 62U;
  const auto& corner = mesh.smooth.corner_node[triangle];
  if (i == 0 && j == 0) return corner[0];
  if (i == n) return corner[1];
  if (j == n) return corner[2];
  const auto on_edge = [&](std::uint32_t edge, std::uint32_t along) {
    // Counted from the edge's lower position, so that both triangles count alike.
    const auto& position = mesh.triangles[triangle].position;
    const std::uint32_t from_low = position[edge] < position[(edge + 1U) % 3U] ? along : n - along;
    return edge_kind | std::uint64_t{mesh.smooth.edge_node[triangle][edge]} << 12U | from_low;
  };
  if (j == 0) return on_edge(0, i);
  if (i + j == n) return on_edge(1, j);
  if (i == 0) return on_edge(2, n - j);
  return interior_kind | std::uint64_t{triangle} << 24U | std::uint64_t{i} << 12U | j;
}

}  // namespace torolux
