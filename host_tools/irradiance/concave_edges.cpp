// SPDX-License-Identifier: MIT
// An edge of one facet alone lies on the border of its surface. Over the middle of it another surface is looked for.
#include "host_tools/irradiance/concave_edges.hpp"

#include <algorithm>
#include <cmath>
#include <span>

#include "host_tools/mesh/edges.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// edge: from this corner to the next one.
bool is_concave(const Mesh& mesh, std::uint32_t side, const MeshFacet& facet, std::size_t edge) {
  const auto corner = grid_corners(mesh.triangles[facet.triangle], facet.code);
  const Vec3d normal = vec::scale(mesh.facet_normal(facet), side == 0 ? 1 : -1);
  return mesh.clearance.rises_from(facet.triangle, normal, corner[edge], corner[(edge + 1) % 3]);
}

}  // namespace

ConcaveEdges::ConcaveEdges(const Mesh& mesh, const SurfaceVertices& vertices, std::uint32_t side,
                           const std::vector<bool>& follows)
    : vertices_(vertices), on_edge_(vertices.count(), false), sides_(mesh.facets.size(), 0) {
  std::vector<std::uint32_t> facets;  // that have an edge between open vertices, and by these
  std::vector<std::array<std::uint32_t, 3>> corners;
  for (std::uint32_t f = 0; f < mesh.facets.size(); ++f) {
    const auto& vertex = vertices.corners(f);
    const auto is_open = [&vertices](std::uint32_t v) { return vertices.open(v); };
    if (!follows[f] || std::ranges::count_if(vertex, is_open) < 2) continue;
    facets.push_back(f);
    corners.push_back(vertex);
  }
  for_each_edge(edge_uses(corners), [&](std::span<const EdgeUse> uses) {
    const EdgeUse& use = uses.front();
    const std::uint32_t f = facets[use.triangle];
    const bool borders = uses.size() == 1 && vertices.open(use.low) && vertices.open(use.high);
    if (!borders || !is_concave(mesh, side, mesh.facets[f], use.edge)) return;
    on_edge_[use.low] = on_edge_[use.high] = true;
    sides_[f] = static_cast<std::uint8_t>(sides_[f] | 1U << use.edge);
  });
  for (std::uint32_t f = 0; f < mesh.facets.size(); ++f) {
    if (follows[f]) continue;
    for (const std::uint32_t v : vertices.corners(f)) on_edge_[v] = false;
  }
  for (const SurfaceVertices::Hanging& at : vertices.hanging()) on_edge_[at.vertex] = false;
}

protocol::ConcaveCorners ConcaveEdges::corners(std::uint32_t facet) const {
  protocol::ConcaveCorners concave = 0;
  for (std::size_t c = 0; c < 3; ++c) concave |= on_edge_[vertices_.corners(facet)[c]] ? 1U << c : 0U;
  for (std::size_t c = 0; c < 3; ++c) {
    const protocol::ConcaveCorners ends = 1U << c | 1U << (c + 1) % 3;
    if (concave == ends && (sides_[facet] >> c & 1U) == 0) concave |= protocol::kSideInside;
  }
  return concave;
}

double light_along(bool from_concave, bool to_concave, double along) {
  if (from_concave == to_concave) return along;
  return from_concave ? std::sqrt(along) : 1 - std::sqrt(1 - along);
}

}  // namespace torolux
