// SPDX-License-Identifier: MIT
// See smooth_surfaces.hpp.
#include "host_tools/mesh/smooth_surfaces.hpp"

#include <algorithm>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/edges.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

Vec3d unit_normal(const MeshTriangle& triangle) {
  const Vec3d corner = to_double(triangle.corner[0]);
  return vec::unit(vec::cross(vec::subtract(to_double(triangle.corner[1]), corner),
                              vec::subtract(to_double(triangle.corner[2]), corner)));
}

bool smooth_across(const Mesh& mesh, const EdgeUse& a, const EdgeUse& b) {
  const MeshTriangle& first = mesh.triangles[a.triangle];
  const MeshTriangle& second = mesh.triangles[b.triangle];
  return first.sides != 0 && first.sides == second.sides && first.material == second.material &&
         a.forward != b.forward && vec::dot(unit_normal(first), unit_normal(second)) > kSmoothCosine;
}

/// Corner of a use's triangle at the edge's lower position, then at its higher one.
std::array<std::uint32_t, 2> end_nodes(const EdgeUse& use) {
  const std::uint32_t from = 3 * use.triangle + use.edge;
  const std::uint32_t to = 3 * use.triangle + (use.edge + 1U) % 3U;
  return use.forward ? std::array{from, to} : std::array{to, from};
}

}  // namespace

SmoothSurfaces find_smooth_surfaces(const Mesh& mesh) {
  std::vector<std::array<std::uint32_t, 3>> positions;
  positions.reserve(mesh.triangles.size());
  for (const MeshTriangle& triangle : mesh.triangles) positions.push_back(triangle.position);
  const std::vector<EdgeUse> uses = edge_uses(positions);
  const std::size_t nodes = 3 * mesh.triangles.size();
  DisjointSets corners(nodes);
  DisjointSets edges(nodes);
  for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
    // A third triangle at an edge is a wall that stands there: light on one side of it must not show on the other.
    if (edge.size() != 2 || !smooth_across(mesh, edge[0], edge[1])) return;
    edges.merge(3 * edge[0].triangle + edge[0].edge, 3 * edge[1].triangle + edge[1].edge);
    const auto ends = end_nodes(edge[0]);
    const auto other_ends = end_nodes(edge[1]);
    corners.merge(ends[0], other_ends[0]);
    corners.merge(ends[1], other_ends[1]);
  });
  SmoothSurfaces surfaces;
  surfaces.edge_level.assign(nodes, protocol::kMostLevels);
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    auto& corner_node = surfaces.corner_node.emplace_back();
    auto& edge_node = surfaces.edge_node.emplace_back();
    for (std::uint32_t i = 0; i < 3; ++i) {
      corner_node[i] = corners.root(3 * t + i);
      edge_node[i] = edges.root(3 * t + i);
      std::uint8_t& level = surfaces.edge_level[edge_node[i]];
      level = std::min(level, mesh.triangles[t].element_level);
    }
  }
  return surfaces;
}

}  // namespace torolux
