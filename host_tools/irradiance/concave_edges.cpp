// SPDX-License-Identifier: MIT
// An edge of one facet alone lies on the border of its surface. Over the middle of it another surface is looked for.
#include "host_tools/irradiance/concave_edges.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// From corner `corner` of a facet to the next one.
struct Edge {
  std::uint32_t low, high;  ///< vertices
  std::uint32_t facet, corner;

  bool same_ends(const Edge& other) const { return low == other.low && high == other.high; }
};

/// Those whose ends are open, sorted by these.
std::vector<Edge> open_edges(const SurfaceVertices& vertices, const std::vector<bool>& follows) {
  std::vector<Edge> edges;
  for (std::uint32_t f = 0; f < follows.size(); ++f) {
    if (!follows[f]) continue;
    const auto& vertex = vertices.corners(f);
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::uint32_t a = vertex[c];
      const std::uint32_t b = vertex[(c + 1) % 3];
      if (vertices.open(a) && vertices.open(b)) edges.push_back({std::min(a, b), std::max(a, b), f, c});
    }
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.facet, a.corner) < std::tie(b.low, b.high, b.facet, b.corner);
  });
  return edges;
}

bool is_concave(const Mesh& mesh, std::uint32_t side, const Edge& edge) {
  const MeshFacet& facet = mesh.facets[edge.facet];
  const auto corner = grid_corners(mesh.triangles[facet.triangle], facet.code);
  const Vec3d normal = vec::scale(mesh.facet_normal(facet), side == 0 ? 1 : -1);
  return mesh.clearance.rises_from(facet.triangle, normal, corner[edge.corner], corner[(edge.corner + 1) % 3]);
}

}  // namespace

ConcaveEdges::ConcaveEdges(const Mesh& mesh, const SurfaceVertices& vertices, std::uint32_t side,
                           const std::vector<bool>& follows)
    : vertices_(vertices), on_edge_(vertices.count(), false), sides_(mesh.facets.size(), 0) {
  const std::vector<Edge> edges = open_edges(vertices, follows);
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const Edge& edge = edges[i];
    const bool shared =
        (i > 0 && edge.same_ends(edges[i - 1])) || (i + 1 < edges.size() && edge.same_ends(edges[i + 1]));
    if (shared || !is_concave(mesh, side, edge)) continue;
    on_edge_[edge.low] = on_edge_[edge.high] = true;
    sides_[edge.facet] = static_cast<std::uint8_t>(sides_[edge.facet] | 1U << edge.corner);
  }
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
