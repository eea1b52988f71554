// SPDX-License-Identifier: MIT
// See lattice.hpp.
#include "host_tools/mesh/lattice.hpp"

#include <algorithm>
#include <array>
#include <numbers>
#include <unordered_map>

#include "host_tools/mesh/cluster_vertices.hpp"
#include "host_tools/mesh/surface_vertices.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// An element's own light against that of its corners is made up for at borders so many times.
constexpr int kBorderSteps = 1;

/// Where less of an element's area is seen, what shows there is its neighbours' light.
constexpr double kNarrow = 0.5;

/// Irradiance at all vertices of one side [quanta / user unit^2].
class SideLight {
 public:
  /// narrow, covered: by facet, whether little of it is seen and whether a thing lies on a part of it; outlive this.
  SideLight(const Mesh& mesh, std::span<const protocol::Flux> flux, const std::vector<bool>& narrow,
            const std::vector<bool>& covered, std::uint32_t side)
      : mesh_(mesh),
        flux_(flux),
        narrow_(narrow),
        covered_(covered),
        side_(side),
        vertices_(mesh, side),
        clusters_(mesh) {
    take_means();
    settle();
    for (int step = 0; step < kBorderSteps; ++step) {
      follow_to_borders();
      settle();
    }
    note_lit_sides();
  }

  std::uint64_t fits() const { return clusters_.fits(); }
  const std::array<std::uint32_t, 3>& corners(std::uint32_t facet) const { return vertices_.corners(facet); }
  /// Irradiance at a facet's corners.
  std::array<Vec3d, 3> at_corners(const MeshPatch& patch, std::uint32_t facet) const {
    std::array<Vec3d, 3> light{};
    for (std::size_t c = 0; c < 3; ++c) light[c] = values_[corners(facet)[c]];
    if (patch.is_clustered()) {
      const Vec3d normal = mesh_.facet_normal(mesh_.facets[facet]);
      for (std::size_t c = 0; c < 3; ++c) light[c] = clusters_.facing(corners(facet)[c], normal, light[c]);
    }
    if (narrow_[facet] && is_hidden(facet)) show_lit_side(facet, light);
    return light;
  }

 private:
  template <typename Visit>
  void for_each_facet(const Visit& visit) const {
    for (const MeshPatch& patch : mesh_.patches) {
      if (patch.side[side_] == protocol::kNoSide) continue;
      for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
        visit(patch, f, flux_[patch.first_element[side_] + mesh_.facets[f].element]);
      }
    }
  }
  /// All of it lies under a thing, or so it seems.
  bool is_hidden(std::uint32_t facet) const {
    return !mesh_.facets[facet].sends_from ||
           std::ranges::any_of(corners(facet), [this](std::uint32_t v) { return !known_[v]; });
  }
  static bool is_dark(const Vec3d& light) { return light == Vec3d{0, 0, 0}; }
  static double sum_of(const Vec3d& light) { return light[0] + light[1] + light[2]; }
  std::uint64_t key(std::uint32_t facet, std::size_t corner) const {
    return vertex_key(mesh_, mesh_.facets[facet].triangle, grid_points(mesh_.facets[facet].code)[corner]);
  }

  /// What narrow elements' corners are on the other side of the wall, where light comes.
  void note_lit_sides() {
    for (std::uint32_t f = 0; f < mesh_.facets.size(); ++f) {
      if (!narrow_[f]) continue;
      for (std::size_t c = 0; c < 3; ++c) lit_.emplace(key(f, c), Vec3d{0, 0, 0});
    }
    if (lit_.empty()) return;
    for_each_facet([&](const MeshPatch&, std::uint32_t f, const protocol::Flux&) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = corners(f)[c];
        const Vec3d& light = values_[v];
        const auto found = is_dark(light) || !known_[v] ? lit_.end() : lit_.find(key(f, c));
        if (found != lit_.end() && sum_of(found->second) < sum_of(light)) found->second = light;
      }
    });
  }

  /// No light at all on the side of the wall where its middle is: that is what the wall's thing covers, and none of it
  /// is seen. What is seen lies on the other side.
  void show_lit_side(std::uint32_t facet, std::array<Vec3d, 3>& light) const {
    std::array<Vec3d, 3> beyond{};
    Vec3d sum{0, 0, 0};
    double known = 0;
    for (std::size_t c = 0; c < 3; ++c) {
      beyond[c] = lit_.at(key(facet, c));
      if (is_dark(beyond[c])) continue;
      sum = vec::add(sum, beyond[c]);
      known += 1;
    }
    if (!(known > 0)) return;
    for (std::size_t c = 0; c < 3; ++c) light[c] = is_dark(beyond[c]) ? vec::scale(sum, 1 / known) : beyond[c];
  }

  static void add_part(VertexSum& sum, const protocol::Flux& flux, double part, double area) {
    for (std::size_t c = 0; c < 3; ++c) sum.flux[c] += part * static_cast<double>(flux[c]);
    sum.area += area;
  }

  void take_means() {
    std::vector<VertexSum> sums(vertices_.count());
    std::vector<VertexSum> of_narrow(vertices_.count());
    at_wall_.assign(vertices_.count(), false);
    for_each_facet([&](const MeshPatch& patch, std::uint32_t f, const protocol::Flux& flux) {
      if (patch.is_clustered()) {
        clusters_.add(patch, f, corners(f), flux);
        return;
      }
      // Of what is narrow neither the area nor, from few records, the light is known well.
      auto& into = narrow_[f] ? of_narrow : sums;
      const MeshFacet& facet = mesh_.facets[f];
      const double area = mesh_.facet_area(facet) * (facet.is_piece ? 1 : facet.seen);
      for (const std::uint32_t corner : corners(f)) {
        add_part(into[corner], flux, facet.of_element, area);
        if (facet.seen < 1) at_wall_[corner] = true;
      }
    });
    clusters_.smooth(sums);
    for (std::size_t v = 0; v < sums.size(); ++v) {
      measured_.push_back(sums[v].area > 0);
      values_.push_back((sums[v].area > 0 ? sums[v] : of_narrow[v]).irradiance());
    }
  }

  void settle() {
    spread();
    anchor();
  }

  /// Vertices among what is narrow take their light from vertices on the same side, from one to the next.
  /// What cannot be reached so shows what came there, unless a thing lies on a part of it: then it stays unknown.
  void spread() {
    known_ = measured_;
    for (const SurfaceVertices::Hanging& hanging : vertices_.hanging()) {
      if (!known_[hanging.from] || !known_[hanging.to]) continue;
      values_[hanging.vertex] = between_ends(hanging);
      known_[hanging.vertex] = true;
    }
    for (bool more = true; more;) {
      more = false;
      std::vector<Vec3d> sums(values_.size(), {0, 0, 0});
      std::vector<double> counts(values_.size(), 0);
      for (std::uint32_t f = 0; f < narrow_.size(); ++f) {
        if (!narrow_[f]) continue;
        for (const std::uint32_t from : corners(f)) {
          for (const std::uint32_t to : corners(f)) {
            if (!known_[from] || known_[to]) continue;
            sums[to] = vec::add(sums[to], values_[from]);
            counts[to] += 1;
          }
        }
      }
      for (std::size_t v = 0; v < counts.size(); ++v) {
        if (!(counts[v] > 0)) continue;
        values_[v] = vec::scale(sums[v], 1 / counts[v]);
        known_[v] = more = true;
      }
    }
    for (std::uint32_t f = 0; f < narrow_.size(); ++f) {
      if (!narrow_[f] || covered_[f]) continue;
      for (const std::uint32_t v : corners(f)) known_[v] = true;
    }
  }

  void anchor() {
    for (const SurfaceVertices::Hanging& hanging : vertices_.hanging()) values_[hanging.vertex] = between_ends(hanging);
  }
  Vec3d between_ends(const SurfaceVertices::Hanging& hanging) const {
    return vec::add(vec::scale(values_[hanging.from], 1 - hanging.along),
                    vec::scale(values_[hanging.to], hanging.along));
  }

  /// The mean of the elements around a vertex is their light there only if they lie all around it. At a border it is
  /// the light half an element away: what interpolation then lacks of each element's own light is added there.
  void follow_to_borders() {
    std::vector<Vec3d> missing(vertices_.count(), {0, 0, 0});
    std::vector<double> area(vertices_.count(), 0);
    for_each_facet([&](const MeshPatch& patch, std::uint32_t f, const protocol::Flux& flux) {
      if (patch.is_clustered() || mesh_.facets[f].seen < 1) return;
      const double facet_area = mesh_.facet_area(mesh_.facets[f]);
      const auto& corner = corners(f);
      for (std::size_t c = 0; c < 3; ++c) {
        const double mean = (values_[corner[0]][c] + values_[corner[1]][c] + values_[corner[2]][c]) / 3;
        for (const std::uint32_t v : corner) missing[v][c] += static_cast<double>(flux[c]) - mean * facet_area;
      }
      for (const std::uint32_t v : corner) area[v] += facet_area;
    });
    for (std::uint32_t v = 0; v < values_.size(); ++v) {
      if (!vertices_.open(v) || !(area[v] > 0) || at_wall_[v]) continue;
      for (std::size_t c = 0; c < 3; ++c) values_[v][c] = std::max(0.0, values_[v][c] + missing[v][c] / area[v]);
    }
  }

  const Mesh& mesh_;
  std::span<const protocol::Flux> flux_;
  const std::vector<bool>& narrow_;
  const std::vector<bool>& covered_;
  std::uint32_t side_;
  SurfaceVertices vertices_;
  ClusterVertices clusters_;
  std::vector<Vec3d> values_;
  std::vector<bool> at_wall_;                     ///< by vertex: of elements of which a part is seen, or covered
  std::vector<bool> measured_;                    ///< by vertex: of elements that no wall crosses
  std::vector<bool> known_;                       ///< or taken from such a vertex
  std::unordered_map<std::uint64_t, Vec3d> lit_;  ///< by vertex_key
};

}  // namespace

Lattice make_lattice(const Mesh& mesh, std::span<const protocol::Flux> flux, double watts_per_quantum,
                     double unit_radiance) {
  std::vector<bool> narrow;
  std::vector<bool> covered;
  for (const MeshFacet& facet : mesh.facets) {
    narrow.push_back(facet.seen < kNarrow);
    covered.push_back(facet.sends_from != facet.code);
  }
  const std::array<SideLight, 2> light{SideLight(mesh, flux, narrow, covered, 0),
                                       SideLight(mesh, flux, narrow, covered, 1)};
  const double factor = watts_per_quantum / (std::numbers::pi * unit_radiance);
  Lattice lattice;
  lattice.fits = light[0].fits() + light[1].fits();
  lattice.first.assign(mesh.facets.size(), 0);
  for (const MeshPatch& patch : mesh.patches) {
    for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
      lattice.first[f] = static_cast<std::uint32_t>(lattice.triangles.size());
      for (std::uint32_t side = 0; side < 2; ++side) {
        if (patch.side[side] == protocol::kNoSide) continue;
        protocol::LatticeTriangle& triangle = lattice.triangles.emplace_back();
        const std::array<Vec3d, 3> corners = light[side].at_corners(patch, f);
        for (std::size_t c = 0; c < 3; ++c) triangle.irradiance_over_pi[c] = to_float(vec::scale(corners[c], factor));
      }
    }
  }
  return lattice;
}

}  // namespace torolux
