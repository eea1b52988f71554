// SPDX-License-Identifier: MIT
// Of each edge that may pass radiance on, ends and edge are joined in disjoint sets. Their roots are the names by which
// grid points of different triangles are found to be one vertex.
#include "host_tools/mesh/smooth_surfaces.hpp"

#include <algorithm>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/edges.hpp"
#include "host_tools/mesh/mesh.hpp"
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

/// Corner of a use's triangle at the edge's lower position, then at its higher one.
std::array<std::uint32_t, 2> end_nodes(const EdgeUse& use) {
  const std::uint32_t from = 3 * use.triangle + use.edge;
  const std::uint32_t to = 3 * use.triangle + (use.edge + 1U) % 3U;
  return use.forward ? std::array{from, to} : std::array{to, from};
}

}  // namespace

SmoothSurfaces find_smooth_surfaces(const Mesh& mesh, const std::vector<bool>& small) {
  std::vector<std::array<std::uint32_t, 3>> positions;
  positions.reserve(mesh.triangles.size());
  for (const MeshTriangle& triangle : mesh.triangles) positions.push_back(triangle.position);
  const std::vector<EdgeUse> uses = edge_uses(positions);
  const std::size_t nodes = 3 * mesh.triangles.size();
  DisjointSets corners(nodes);
  DisjointSets edges(nodes);
  SmoothSurfaces surfaces;
  surfaces.neighbour.assign(mesh.triangles.size(), {kNoNeighbour, kNoNeighbour, kNoNeighbour});
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    // A third triangle at an edge is a wall that stands there: light on one side of it must not show on the other.
    if (edge.size() != 2 || !smooth_across(mesh, small, edge[0], edge[1])) return;
    edges.merge(3 * edge[0].triangle + edge[0].edge, 3 * edge[1].triangle + edge[1].edge);
    const auto ends = end_nodes(edge[0]);
    const auto other_ends = end_nodes(edge[1]);
    corners.merge(ends[0], other_ends[0]);
    corners.merge(ends[1], other_ends[1]);
    surfaces.neighbour[edge[0].triangle][edge[0].edge] = edge[1].triangle;
    surfaces.neighbour[edge[1].triangle][edge[1].edge] = edge[0].triangle;
  });
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

std::array<GridPoint, 3> grid_points(std::uint32_t code) {
  const protocol::GridTriangle grid = protocol::grid_triangle_of(code);
  std::array<GridPoint, 3> points{};
  for (std::size_t c = 0; c < 3; ++c) {
    points[c] = {static_cast<std::uint32_t>(grid.corner[c][1]), static_cast<std::uint32_t>(grid.corner[c][2])};
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
