// SPDX-License-Identifier: MIT
// Edges are sorted, so that two of the same ends lie together; an edge that is alone may be a part of a longer one.
#include "host_tools/irradiance/filter_plan.hpp"

#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "host_tools/irradiance/concave_edges.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

/// From a triangle's corner `corner` to the next one.
struct FilterPlan::Edge {
  std::uint32_t low, high;  ///< vertices
  std::uint32_t triangle, corner;

  std::pair<std::uint32_t, std::uint32_t> ends() const { return {low, high}; }
};

void FilterPlan::add(const Mesh& mesh, std::uint32_t facet, std::uint32_t element,
                     const std::array<std::uint32_t, 3>& corner, protocol::ConcaveCorners concave) {
  const MeshFacet& of = mesh.facets[facet];
  triangles_.push_back({element, corner, mesh.facet_area(of), concave, mean_weights(concave)});
  auto& places = places_.emplace_back(grid_corners(mesh.triangles[of.triangle], of.code));
  for (Vec3d& place : places) place = vec::scale(place, 1 / mesh.space.scale);
}

void FilterPlan::finish(const std::vector<bool>& kept, std::vector<Hanging> hanging) {
  hanging_ = std::move(hanging);
  between_.assign(kept.size(), {0, 0});
  for (const Hanging& at : hanging_) between_[at.vertex] = {std::min(at.from, at.to), std::max(at.from, at.to)};
  find_bends();
  find_free(kept);
  places_ = {};
  between_ = {};
}

std::vector<FilterPlan::Edge> FilterPlan::sorted_edges() const {
  std::vector<Edge> edges;
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    for (std::uint32_t c = 0; c < 3; ++c) {
      const std::uint32_t a = triangles_[t].corner[c];
      const std::uint32_t b = triangles_[t].corner[(c + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t, c});
    }
  }
  std::ranges::sort(edges, [](const Edge& a, const Edge& b) {
    return std::tie(a.low, a.high, a.triangle, a.corner) < std::tie(b.low, b.high, b.triangle, b.corner);
  });
  return edges;
}

void FilterPlan::find_bends() {
  const std::vector<Edge> edges = sorted_edges();
  for (std::size_t begin = 0; begin < edges.size();) {
    std::size_t end = begin + 1;
    while (end < edges.size() && edges[end].ends() == edges[begin].ends()) ++end;
    if (end - begin == 2) add_bend(edges[begin], edges[begin + 1]);
    if (end - begin == 1) find_part_of_longer(edges, edges[begin]);
    begin = end;
  }
}

/// One of its ends, at least, hangs on that longer edge; the other does, too, or is its end.
void FilterPlan::find_part_of_longer(const std::vector<Edge>& edges, const Edge& edge) {
  for (const auto& [hangs, other] : {std::pair(edge.low, edge.high), std::pair(edge.high, edge.low)}) {
    const auto [from, to] = between_[hangs];
    if (from == to) continue;
    if (other != from && other != to && between_[other] != between_[hangs]) continue;
    const auto found = std::ranges::lower_bound(edges, std::pair(from, to), {}, &Edge::ends);
    if (found == edges.end() || found->ends() != std::pair(from, to)) continue;
    add_bend(edge, *found);
    return;
  }
}

/// By how much more it rises from the edge into the second triangle than it fell towards it in the first: of each, the
/// height of the third corner over the edge. The part of the integral: Bergou, Wardetzky, Harmon, Zorin & Grinspun
/// 2006, "A quadratic bending model for inextensible surfaces".
void FilterPlan::add_bend(const Edge& a, const Edge& b) {
  Bend bend{};
  std::size_t known = 0;
  const auto add_term = [&](std::uint32_t vertex, double of) {
    const auto end = bend.vertex.begin() + static_cast<std::ptrdiff_t>(known);
    const auto found = std::find(bend.vertex.begin(), end, vertex);
    bend.of[static_cast<std::size_t>(found - bend.vertex.begin())] += of;
    if (found == end) bend.vertex[known++] = vertex;
  };
  double shared = 0;
  for (const Edge* edge : {&b, &a}) {
    const Triangle& triangle = triangles_[edge->triangle];
    const auto& place = places_[edge->triangle];
    const std::size_t c = edge->corner;
    const Vec3d along = vec::subtract(place[(c + 1) % 3], place[c]);
    shared = vec::length(along);
    const double height = 2 * triangle.area / shared / slope_at_side(triangle.concave, (c + 2) % 3);
    const double foot = vec::dot(vec::subtract(place[(c + 2) % 3], place[c]), along) / (shared * shared);
    add_term(triangle.corner[(c + 2) % 3], 1 / height);
    add_term(triangle.corner[c], (foot - 1) / height);
    add_term(triangle.corner[(c + 1) % 3], -foot / height);
  }
  for (; known < bend.vertex.size(); ++known) bend.vertex[known] = bend.vertex[0];
  bend.triangle = {b.triangle, a.triangle};
  bend.curvature = 3 * shared * shared / (triangles_[a.triangle].area + triangles_[b.triangle].area);
  bends_.push_back(bend);
}

void FilterPlan::find_free(const std::vector<bool>& kept) {
  std::vector<bool> counts(kept.size(), false);
  for (const Triangle& triangle : triangles_) {
    for (const std::uint32_t v : triangle.corner) counts[v] = true;
  }
  for (const Hanging& at : hanging_) counts[at.vertex] = false;
  for (std::uint32_t v = 0; v < kept.size(); ++v) {
    if (counts[v] && !kept[v]) free_.push_back(v);
  }
}

}  // namespace torolux
