// SPDX-License-Identifier: MIT
// For each side: whose flux counts at a vertex, how light spreads to what is narrow, which borders are corrected, and
// where hidden corners show the lit side of a wall.
#include "host_tools/irradiance/irradiance_plan.hpp"

#include <algorithm>
#include <unordered_map>

#include "host_tools/irradiance/concave_edges.hpp"

namespace torolux {
namespace {

/// Where less of an element's area is seen, what shows there is its neighbours' light.
constexpr double kNarrow = 0.5;

class SidePlanner {
 public:
  /// first: by facet, of its entries in VertexIrradiance.
  SidePlanner(const Mesh& mesh, const std::vector<std::uint32_t>& first, std::uint32_t side)
      : mesh_(mesh),
        first_(first),
        side_(side),
        vertices_(mesh, side),
        follows_(follows_corners(mesh, side)),
        concave_(mesh, vertices_, side, follows_) {
    for (const MeshFacet& facet : mesh.facets) {
      narrow_.push_back(facet.seen < kNarrow);
      covered_.push_back(facet.sends_from != facet.code);
    }
    plan_.anchored = vertices_.hanging();
    hangs_.assign(vertices_.count(), false);
    for (SidePlan::Hanging& at : plan_.anchored) {
      at.along = light_along(concave_.has(at.from), concave_.has(at.to), at.along);
      hangs_[at.vertex] = true;
    }
  }

  SidePlan make() {
    take_facets();
    plan_means();
    plan_spread();
    plan_borders();
    plan_lit_sides();
    plan_filter();
    return std::move(plan_);
  }

 private:
  using Facet = SidePlan::Facet;

  const SidePlan::Corners& corners(std::uint32_t facet) const { return vertices_.corners(facet); }

  /// Clusters have fits of their own, and what walls cut is known too badly: light over others follows their corners.
  static std::vector<bool> follows_corners(const Mesh& mesh, std::uint32_t side) {
    std::vector<bool> follows(mesh.facets.size(), false);
    for (const MeshPatch& patch : mesh.patches) {
      if (patch.side[side] == protocol::kNoSide || patch.is_clustered()) continue;
      for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
        const MeshFacet& facet = mesh.facets[f];
        follows[f] = !facet.is_piece && !(facet.seen < 1) && facet.of_element == 1;
      }
    }
    return follows;
  }

  void take_facets() {
    for (const MeshPatch& patch : mesh_.patches) {
      if (patch.side[side_] == protocol::kNoSide) continue;
      // The back's triangle lies behind the front's.
      const bool behind = side_ == 1 && patch.side[0] != protocol::kNoSide;
      for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
        const MeshFacet& facet = mesh_.facets[f];
        Facet& here =
            plan_.facets.emplace_back(Facet{patch.first_element[side_] + facet.element, first_[f] + (behind ? 1 : 0),
                                            corners(f), 0, concave_.corners(f), facet.of_element});
        if (patch.is_clustered()) here.of_cluster = plan_.clusters.add(mesh_, f, corners(f), here.element);
        number_.push_back(f);
      }
    }
    plan_.clusters.finish(mesh_);
  }

  /// A vertex takes the mean of the elements around it. Of what is narrow neither the area nor, from few records, the
  /// light is known well: it counts where nothing else is.
  void plan_means() {
    std::vector<double> area(vertices_.count(), 0);
    std::vector<double> of_narrow(vertices_.count(), 0);
    at_wall_.assign(vertices_.count(), false);
    for (std::size_t i = 0; i < plan_.facets.size(); ++i) {
      if (plan_.facets[i].of_cluster != SidePlan::kNone) continue;
      const MeshFacet& facet = mesh_.facets[number_[i]];
      const double facet_area = mesh_.facet_area(facet) * (facet.is_piece ? 1 : facet.seen);
      for (const std::uint32_t v : plan_.facets[i].corner) {
        (narrow_[number_[i]] ? of_narrow : area)[v] += facet_area;
        if (facet.seen < 1) at_wall_[v] = true;
      }
    }
    plan_.clusters.add_areas(area);
    for (std::size_t v = 0; v < area.size(); ++v) {
      known_.push_back(area[v] > 0);
      plan_.area.push_back(area[v] > 0 ? area[v] : of_narrow[v]);
    }
    for (std::size_t i = 0; i < plan_.facets.size(); ++i) {
      Facet& facet = plan_.facets[i];
      if (facet.of_cluster != SidePlan::kNone) continue;
      for (std::size_t c = 0; c < 3; ++c) {
        if (known_[facet.corner[c]] != narrow_[number_[i]]) facet.counts |= 1U << c;
      }
    }
  }

  /// Vertices among what is narrow take their light from vertices on the same side, from one to the next.
  /// What cannot be reached so shows what came there, unless a thing lies on a part of it: then it stays unknown.
  void plan_spread() {
    for (const SidePlan::Hanging& hanging : plan_.anchored) {
      if (!known_[hanging.from] || !known_[hanging.to]) continue;
      plan_.first_known.push_back(hanging);
      known_[hanging.vertex] = true;
    }
    while (spread_once()) {
    }
    for (std::uint32_t f = 0; f < narrow_.size(); ++f) {
      if (!narrow_[f] || covered_[f]) continue;
      for (const std::uint32_t v : corners(f)) known_[v] = true;
    }
  }
  bool spread_once() {
    std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  // to, from
    for (std::uint32_t f = 0; f < narrow_.size(); ++f) {
      if (!narrow_[f]) continue;
      for (const std::uint32_t from : corners(f)) {
        for (const std::uint32_t to : corners(f)) {
          if (known_[from] && !known_[to]) pairs.emplace_back(to, from);
        }
      }
    }
    // Sums keep the order of the facets: they are of floating point.
    std::ranges::stable_sort(pairs, {}, &std::pair<std::uint32_t, std::uint32_t>::first);
    for (const auto& [to, from] : pairs) {
      if (!known_[to]) plan_.spreads.push_back({to, static_cast<std::uint32_t>(plan_.sources.size()), 0});
      known_[to] = true;
      plan_.sources.push_back(from);
      ++plan_.spreads.back().count;
    }
    return !pairs.empty();
  }

  /// The mean of the elements around a vertex is their light there only if they lie all around it. At a border it is
  /// the light half an element away.
  void plan_borders() {
    const auto is_border = [this](std::uint32_t v) { return vertices_.open(v) && !at_wall_[v] && !hangs_[v]; };
    const auto is_seen_whole = [this](std::size_t i) {
      return plan_.facets[i].of_cluster == SidePlan::kNone && !(mesh_.facets[number_[i]].seen < 1);
    };
    std::vector<double> area(vertices_.count(), 0);
    for (std::size_t i = 0; i < plan_.facets.size(); ++i) {
      if (!is_seen_whole(i)) continue;
      const double facet_area = mesh_.facet_area(mesh_.facets[number_[i]]);
      // On a concave edge light is corrected to the end, as it falls steeply there; elsewhere halfway or so, as what an
      // element lacks may be a peak's.
      const auto of_mean = mean_weights(plan_.facets[i].concave);
      double of_concave = 0;
      for (std::size_t c = 0; c < 3; ++c) of_concave += concave_.has(plan_.facets[i].corner[c]) ? of_mean[c] : 0;
      for (const std::uint32_t v : plan_.facets[i].corner) area[v] += facet_area * (concave_.has(v) ? of_concave : 1);
    }
    std::vector<std::uint32_t> border_of(vertices_.count(), SidePlan::kNone);
    for (std::uint32_t v = 0; v < vertices_.count(); ++v) {
      if (!is_border(v) || !(area[v] > 0)) continue;
      border_of[v] = static_cast<std::uint32_t>(plan_.borders.size());
      plan_.borders.push_back({v, area[v]});
    }
    for (std::size_t i = 0; i < plan_.facets.size(); ++i) {
      if (!is_seen_whole(i)) continue;
      const Facet& facet = plan_.facets[i];
      const auto& [a, b, c] = facet.corner;
      const SidePlan::Corners border{border_of[a], border_of[b], border_of[c]};
      if (std::ranges::all_of(border, [](std::uint32_t at) { return at == SidePlan::kNone; })) continue;
      plan_.border_facets.push_back({facet.element, facet.corner, border, mesh_.facet_area(mesh_.facets[number_[i]]),
                                     mean_weights(facet.concave)});
    }
  }

  std::uint64_t key(std::uint32_t facet, std::size_t corner) const {
    return vertex_key(mesh_, mesh_.facets[facet].triangle, grid_points(mesh_.facets[facet].code)[corner]);
  }
  /// All of it lies under a thing, or so it seems.
  bool is_hidden(std::uint32_t facet) const {
    return !mesh_.facets[facet].sends_from ||
           std::ranges::any_of(corners(facet), [this](std::uint32_t v) { return !known_[v]; });
  }

  /// What narrow elements' corners are on the other side of the wall, where light comes.
  void plan_lit_sides() {
    std::unordered_map<std::uint64_t, std::uint32_t> places;
    for (std::uint32_t f = 0; f < narrow_.size(); ++f) {
      if (!narrow_[f]) continue;
      for (std::size_t c = 0; c < 3; ++c) places.emplace(key(f, c), static_cast<std::uint32_t>(places.size()));
    }
    plan_.lit_places = static_cast<std::uint32_t>(places.size());
    if (places.empty()) return;
    for (std::size_t i = 0; i < plan_.facets.size(); ++i) {
      SidePlan::Corners at{};
      for (std::size_t c = 0; c < 3; ++c) {
        const auto found = places.find(key(number_[i], c));
        at[c] = found == places.end() ? SidePlan::kNone : found->second;
        const std::uint32_t v = plan_.facets[i].corner[c];
        if (at[c] != SidePlan::kNone && known_[v]) plan_.lit.push_back({v, at[c]});
      }
      if (!narrow_[number_[i]] || !is_hidden(number_[i])) continue;
      plan_.facets[i].of_hidden = static_cast<std::uint32_t>(plan_.hidden.size());
      plan_.hidden.push_back(at);
    }
  }

  /// Vertices of what does not follow them keep their light.
  void plan_filter() {
    std::vector<bool> kept(vertices_.count(), false);
    for (std::size_t i = 0; i < plan_.facets.size(); ++i) {
      const Facet& facet = plan_.facets[i];
      if (follows_[number_[i]]) {
        plan_.filter.add(mesh_, number_[i], facet.element, facet.corner, facet.concave);
      } else {
        for (const std::uint32_t v : facet.corner) kept[v] = true;
      }
    }
    plan_.filter.finish(kept, plan_.anchored);
  }

  const Mesh& mesh_;
  const std::vector<std::uint32_t>& first_;
  std::uint32_t side_;
  SurfaceVertices vertices_;
  std::vector<bool> follows_;  ///< by facet: light over it is shown by its corners alone
  ConcaveEdges concave_;
  SidePlan plan_;
  std::vector<bool> hangs_;            ///< by vertex: on a larger element's edge
  std::vector<bool> narrow_;           ///< by facet: little of it is seen
  std::vector<bool> covered_;          ///< by facet: a thing lies on a part of it
  std::vector<std::uint32_t> number_;  ///< of the mesh's facet, by the plan's
  std::vector<bool> at_wall_;          ///< by vertex: of elements of which a part is seen, or covered
  std::vector<bool> known_;            ///< by vertex: of elements that no wall crosses, or taken from such a vertex
};

}  // namespace

IrradiancePlan::IrradiancePlan(const Mesh& mesh) : first(mesh.facets.size(), 0) {
  for (const MeshPatch& patch : mesh.patches) {
    const std::uint32_t sides =
        (patch.side[0] != protocol::kNoSide ? 1U : 0U) + (patch.side[1] != protocol::kNoSide ? 1U : 0U);
    for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
      first[f] = triangles;
      triangles += sides;
    }
  }
  for (std::uint32_t s = 0; s < 2; ++s) side[s] = SidePlanner(mesh, first, s).make();
}

}  // namespace torolux
