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

/// Irradiance at all vertices of one side [quanta / user unit^2].
class SideLight {
 public:
  /// crossed, covered: by facet, whether a wall crosses it and whether a thing lies on a part of it; outlive this.
  SideLight(const Mesh& mesh, std::span<const protocol::Flux> flux, const std::vector<bool>& crossed,
            const std::vector<bool>& covered, std::uint32_t side)
      : mesh_(mesh),
        flux_(flux),
        crossed_(crossed),
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

  const std::array<std::uint32_t, 3>& corners(std::uint32_t facet) const { return vertices_.corners(facet); }
  /// Irradiance at a facet's corners.
  std::array<Vec3d, 3> at_corners(const MeshPatch& patch, std::uint32_t facet) const {
    std::array<Vec3d, 3> light{};
    for (std::size_t c = 0; c < 3; ++c) light[c] = values_[corners(facet)[c]];
    if (patch.is_clustered()) {
      const Vec3d normal = mesh_.facet_normal(mesh_.facets[facet]);
      for (std::size_t c = 0; c < 3; ++c) light[c] = clusters_.facing(corners(facet)[c], normal, light[c]);
    }
    if (crossed_[facet] && is_hidden(facet)) show_lit_side(facet, light);
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
  /// Its middle lies under a thing, or so it seems.
  bool is_hidden(std::uint32_t facet) const {
    const auto no_light = [this](std::uint32_t v) { return is_dark(values_[v]) || !known_[v]; };
    if (std::ranges::any_of(corners(facet), no_light)) return true;
    const MeshFacet& at = mesh_.facets[facet];
    return mesh_.hiding.hides(mesh_, at.triangle, side_, middle_of_grid(at.code));
  }
  static bool is_dark(const Vec3d& light) { return light == Vec3d{0, 0, 0}; }
  std::uint64_t key(std::uint32_t facet, std::size_t corner) const {
    return vertex_key(mesh_, mesh_.facets[facet].triangle, grid_points(mesh_.facets[facet].code)[corner]);
  }

  /// What crossed elements' corners are on the other side of the wall, where light comes.
  void note_lit_sides() {
    for (std::uint32_t f = 0; f < mesh_.facets.size(); ++f) {
      if (!crossed_[f]) continue;
      for (std::size_t c = 0; c < 3; ++c) lit_.emplace(key(f, c), Vec3d{0, 0, 0});
    }
    if (lit_.empty()) return;
    for_each_facet([&](const MeshPatch&, std::uint32_t f, const protocol::Flux&) {
      for (std::size_t c = 0; c < 3; ++c) {
        const std::uint32_t v = corners(f)[c];
        const Vec3d& light = values_[v];
        const auto found = is_dark(light) || !known_[v] ? lit_.end() : lit_.find(key(f, c));
        if (found != lit_.end()) found->second = light;
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

  void take_means() {
    std::vector<VertexSum> sums(vertices_.count());
    std::vector<VertexSum> of_crossed(vertices_.count());
    for_each_facet([&](const MeshPatch& patch, std::uint32_t f, const protocol::Flux& flux) {
      if (patch.is_clustered()) {
        clusters_.add(patch, f, corners(f), flux);
        return;
      }
      // What a wall crosses got the light of both sides, or of a part of its area.
      auto& into = crossed_[f] ? of_crossed : sums;
      for (const std::uint32_t corner : corners(f)) into[corner].add(flux, mesh_.facet_area(mesh_.facets[f]));
    });
    clusters_.smooth(sums);
    for (std::size_t v = 0; v < sums.size(); ++v) {
      measured_.push_back(sums[v].area > 0);
      values_.push_back((sums[v].area > 0 ? sums[v] : of_crossed[v]).irradiance());
    }
  }

  void settle() {
    spread();
    anchor();
  }

  /// Vertices among elements that reach under things take their light from vertices on the same side of the foot, from
  /// one to the next. What cannot be reached so stays unknown. Where a wall only parts two rooms, what crossed elements
  /// got must do: it lies between the light of both, and so does what is seen of them on either side.
  void spread() {
    known_ = measured_;
    for (std::uint32_t f = 0; f < crossed_.size(); ++f) {
      if (!crossed_[f] || covered_[f]) continue;
      for (const std::uint32_t v : corners(f)) known_[v] = true;
    }
    for (bool more = true; more;) {
      more = false;
      std::vector<Vec3d> sums(values_.size(), {0, 0, 0});
      std::vector<double> counts(values_.size(), 0);
      for (std::uint32_t f = 0; f < crossed_.size(); ++f) {
        if (!crossed_[f] || !covered_[f]) continue;
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
  }

  void anchor() {
    for (const SurfaceVertices::Hanging& hanging : vertices_.hanging()) {
      values_[hanging.vertex] = vec::add(vec::scale(values_[hanging.from], 1 - hanging.along),
                                         vec::scale(values_[hanging.to], hanging.along));
    }
  }

  /// The mean of the elements around a vertex is their light there only if they lie all around it. At a border it is
  /// the light half an element away: what interpolation then lacks of each element's own light is added there.
  void follow_to_borders() {
    std::vector<Vec3d> missing(vertices_.count(), {0, 0, 0});
    std::vector<double> area(vertices_.count(), 0);
    for_each_facet([&](const MeshPatch& patch, std::uint32_t f, const protocol::Flux& flux) {
      if (patch.is_clustered() || crossed_[f]) return;
      const double facet_area = mesh_.facet_area(mesh_.facets[f]);
      const auto& corner = corners(f);
      for (std::size_t c = 0; c < 3; ++c) {
        const double mean = (values_[corner[0]][c] + values_[corner[1]][c] + values_[corner[2]][c]) / 3;
        for (const std::uint32_t v : corner) missing[v][c] += static_cast<double>(flux[c]) - mean * facet_area;
      }
      for (const std::uint32_t v : corner) area[v] += facet_area;
    });
    for (std::uint32_t v = 0; v < values_.size(); ++v) {
      if (!vertices_.open(v) || !(area[v] > 0)) continue;
      for (std::size_t c = 0; c < 3; ++c) values_[v][c] = std::max(0.0, values_[v][c] + missing[v][c] / area[v]);
    }
  }

  const Mesh& mesh_;
  std::span<const protocol::Flux> flux_;
  const std::vector<bool>& crossed_;
  const std::vector<bool>& covered_;
  std::uint32_t side_;
  SurfaceVertices vertices_;
  ClusterVertices clusters_;
  std::vector<Vec3d> values_;
  std::vector<bool> measured_;                    ///< by vertex: of elements that no wall crosses
  std::vector<bool> known_;                       ///< or taken from such a vertex
  std::unordered_map<std::uint64_t, Vec3d> lit_;  ///< by vertex_key
};

}  // namespace

Lattice make_lattice(const Mesh& mesh, std::span<const protocol::Flux> flux, double watts_per_quantum,
                     double unit_radiance) {
  std::vector<bool> crossed;
  std::vector<bool> covered;
  crossed.reserve(mesh.facets.size());
  for (const MeshFacet& facet : mesh.facets) {
    crossed.push_back(mesh.walls.cross(facet.triangle, facet.code));
    covered.push_back(crossed.back() && facet.sends_from != facet.code);
  }
  const std::array<SideLight, 2> light{SideLight(mesh, flux, crossed, covered, 0),
                                       SideLight(mesh, flux, crossed, covered, 1)};
  const double factor = watts_per_quantum / (std::numbers::pi * unit_radiance);
  Lattice lattice;
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
