// SPDX-License-Identifier: MIT
// Corners at a common edge are joined, from large elements to small, unless a wall lies on the way from one element to
// the other. Corners amid a longer edge hang between its ends.
#include "host_tools/irradiance/surface_vertices.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <tuple>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/edges.hpp"

namespace torolux {
namespace {

PlanePoint on_plane(double i, double j) {
  constexpr double unit = 1.0 / (1U << protocol::kMostLevels);
  return {unit * i, unit * j};
}

/// Points of an edge, from one end to the other, that may be free where a thing lies on its middle.
constexpr std::array kOtherWays{0.1, 0.25, 0.75, 0.9};

/// An edge of a facet, from corner `corner` to the next one.
struct FacetEdge {
  std::uint64_t low, high;  ///< keys of its ends, low < high
  std::uint32_t facet;
  std::uint32_t corner;
};

/// Joins facets' corners, three to a facet, into vertices.
class Joiner {
 public:
  Joiner(const Mesh& mesh, std::uint32_t side)
      : mesh_(mesh), side_(side), sets_(3 * mesh.facets.size()), links_(3 * mesh.facets.size(), 0) {
    for (std::uint32_t f = 0; f < mesh.facets.size(); ++f) {
      const auto corners = grid_points(mesh.facets[f].code);
      for (std::size_t c = 0; c < 3; ++c) {
        keys_.push_back(vertex_key(mesh, mesh.facets[f].triangle, corners[c]));
      }
      if (!present(f)) continue;
      for (std::uint32_t c = 0; c < 3; ++c) {
        const std::uint64_t a = keys_[3 * f + c];
        const std::uint64_t b = keys_[3 * f + (c + 1) % 3];
        edges_.push_back({std::min(a, b), std::max(a, b), f, c});
      }
    }
    std::sort(edges_.begin(), edges_.end(), [](const FacetEdge& a, const FacetEdge& b) {
      return std::tie(a.low, a.high, a.facet) < std::tie(b.low, b.high, b.facet);
    });
    vertices_ = keys_;
    std::sort(vertices_.begin(), vertices_.end());
    join_all();
  }

  bool present(std::uint32_t facet) const {
    return (mesh_.triangles[mesh_.facets[facet].triangle].sides & (1U << side_)) != 0;
  }
  std::uint32_t vertex(std::uint32_t node) { return sets_.root(node); }
  /// Facets that lie side by side around a vertex.
  std::uint32_t links(std::uint32_t node) const { return links_[node]; }
  const std::vector<SurfaceVertices::Hanging>& hanging() const { return hanging_; }  ///< of nodes

 private:
  /// A part of an edge of `facet`: from where to where between the edge's ends, 0..1.
  struct Part {
    std::uint32_t facet, corner;
    GridPoint from, to;
    double begin, end;
  };

  void join_all() {
    std::vector<std::uint32_t> order(mesh_.facets.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
      return protocol::level_of_code(mesh_.facets[a].code) < protocol::level_of_code(mesh_.facets[b].code);
    });
    for (const std::uint32_t f : order) {
      if (!present(f)) continue;
      const auto corners = grid_points(mesh_.facets[f].code);
      for (std::uint32_t c = 0; c < 3; ++c) join({f, c, corners[c], corners[(c + 1) % 3], 0, 1});
    }
  }

  std::uint64_t key(std::uint32_t facet, const GridPoint& point) const {
    return vertex_key(mesh_, mesh_.facets[facet].triangle, point);
  }

  std::span<const FacetEdge> edges_between(std::uint64_t a, std::uint64_t b) const {
    const auto ends = [](const FacetEdge& e) { return std::tie(e.low, e.high); };
    const std::pair wanted{std::min(a, b), std::max(a, b)};
    const auto from = std::partition_point(edges_.begin(), edges_.end(), [&](const FacetEdge& e) {
      return std::pair{e.low, e.high} < wanted;
    });
    auto to = from;
    while (to != edges_.end() && ends(*to) == std::tie(wanted.first, wanted.second)) ++to;
    return {from, to};
  }

  void join(const Part& part) {
    const std::uint64_t from = key(part.facet, part.from);
    const std::uint64_t to = key(part.facet, part.to);
    bool other = false;
    for (const FacetEdge& edge : edges_between(from, to)) {
      if (edge.facet == part.facet) continue;
      other = true;
      if (!wall_between(part, edge)) join_ends(part, from, edge);
    }
    if (other || (part.from.i + part.to.i) % 2 != 0 || (part.from.j + part.to.j) % 2 != 0) return;
    const GridPoint middle{(part.from.i + part.to.i) / 2, (part.from.j + part.to.j) / 2};
    if (!std::binary_search(vertices_.begin(), vertices_.end(), key(part.facet, middle))) return;
    const double half = (part.begin + part.end) / 2;
    join({part.facet, part.corner, part.from, middle, part.begin, half});
    join({part.facet, part.corner, middle, part.to, half, part.end});
  }

  /// On the way from one facet over the middle of the shared edge to the other; where a thing lies on a part of them,
  /// on other ways, too.
  bool wall_between(const Part& part, const FacetEdge& edge) const {
    const auto corners = grid_points(mesh_.facets[edge.facet].code);
    const bool same_way = keys_[3 * edge.facet + edge.corner] == key(part.facet, part.from);
    const GridPoint& a = corners[same_way ? edge.corner : (edge.corner + 1) % 3];
    const GridPoint& b = corners[same_way ? (edge.corner + 1) % 3 : edge.corner];
    const auto blocked = [&](double along) {
      return wall_before(part.facet, part.from, part.to, along) || wall_before(edge.facet, a, b, along);
    };
    if (!blocked(0.5)) return false;
    return !(partly_covered(part.facet) || partly_covered(edge.facet)) || std::ranges::all_of(kOtherWays, blocked);
  }
  bool partly_covered(std::uint32_t facet) const { return mesh_.facets[facet].sends_from != mesh_.facets[facet].code; }
  /// Between the middle of what is seen of a facet and a point of its edge.
  bool wall_before(std::uint32_t facet, const GridPoint& a, const GridPoint& b, double along) const {
    const MeshFacet& from = mesh_.facets[facet];
    return mesh_.walls.between(from.triangle, side_, middle_of_grid(from.sends_from.value_or(from.code)),
                               on_plane(a.i * (1 - along) + b.i * along, a.j * (1 - along) + b.j * along));
  }

  void join_ends(const Part& part, std::uint64_t from, const FacetEdge& edge) {
    const std::uint32_t first = 3 * part.facet + part.corner;
    const std::uint32_t last = 3 * part.facet + (part.corner + 1) % 3;
    const bool whole = part.begin == 0 && part.end == 1;
    for (const std::uint32_t corner : {edge.corner, (edge.corner + 1) % 3}) {
      const std::uint32_t node = 3 * edge.facet + corner;
      const double along = keys_[node] == from ? part.begin : part.end;
      if (along > 0 && along < 1) {
        hanging_.push_back({node, first, last, along});
        continue;
      }
      sets_.merge(along > 0 ? last : first, node);
      if (!whole || part.facet < edge.facet) ++links_[node];
    }
  }

  const Mesh& mesh_;
  std::uint32_t side_;
  std::vector<std::uint64_t> keys_;      ///< by node
  std::vector<std::uint64_t> vertices_;  ///< the same, ascending
  std::vector<FacetEdge> edges_;
  DisjointSets sets_;
  std::vector<std::uint32_t> links_;  ///< by node
  std::vector<SurfaceVertices::Hanging> hanging_;
};

}  // namespace

SurfaceVertices::SurfaceVertices(const Mesh& mesh, std::uint32_t side) {
  Joiner joiner(mesh, side);
  const auto nodes = static_cast<std::uint32_t>(3 * mesh.facets.size());
  std::vector<std::uint32_t> number(nodes, protocol::kNoSide);
  std::vector<std::uint32_t> facets;
  std::vector<std::uint32_t> links;
  for (std::uint32_t node = 0; node < nodes; ++node) {
    std::uint32_t& vertex = number[joiner.vertex(node)];
    if (vertex == protocol::kNoSide) {
      vertex = static_cast<std::uint32_t>(facets.size());
      facets.push_back(0);
      links.push_back(0);
    }
    ++facets[vertex];
    links[vertex] += joiner.links(node);
    if (node % 3 == 0) corner_.emplace_back();
    corner_.back()[node % 3] = vertex;
  }
  for (std::size_t v = 0; v < facets.size(); ++v) open_.push_back(links[v] < facets[v]);
  for (const Hanging& hanging : joiner.hanging()) {
    const auto vertex = [&](std::uint32_t node) { return number[joiner.vertex(node)]; };
    hanging_.push_back({vertex(hanging.vertex), vertex(hanging.from), vertex(hanging.to), hanging.along});
  }
}

}  // namespace torolux
