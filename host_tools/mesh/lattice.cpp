// SPDX-License-Identifier: MIT
// See lattice.hpp.
#include "host_tools/mesh/lattice.hpp"

#include <algorithm>
#include <array>
#include <numbers>

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
  SideLight(const Mesh& mesh, std::span<const protocol::Flux> flux, std::uint32_t side)
      : mesh_(mesh), flux_(flux), side_(side), vertices_(mesh, side) {
    take_means();
    anchor();
    for (int step = 0; step < kBorderSteps; ++step) {
      follow_to_borders();
      anchor();
    }
  }

  const std::array<std::uint32_t, 3>& corners(std::uint32_t facet) const { return vertices_.corners(facet); }
  const Vec3d& at(std::uint32_t vertex) const { return values_[vertex]; }

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
  static bool clustered(const MeshPatch& patch) { return patch.facets > patch.elements; }

  void take_means() {
    std::vector<VertexSum> sums(vertices_.count());
    std::vector<VertexSum> crossed(vertices_.count());
    ClusterVertices clusters(mesh_);
    for_each_facet([&](const MeshPatch& patch, std::uint32_t f, const protocol::Flux& flux) {
      if (clustered(patch)) {
        clusters.add(patch, f, corners(f), flux);
        return;
      }
      // What a wall crosses got the light of both sides: it counts only where there is nothing else.
      auto& into = mesh_.walls.cross(mesh_.facets[f].triangle, mesh_.facets[f].code) ? crossed : sums;
      for (const std::uint32_t corner : corners(f)) into[corner].add(flux, mesh_.facet_area(mesh_.facets[f]));
    });
    clusters.smooth(sums);
    for (std::size_t v = 0; v < sums.size(); ++v) {
      values_.push_back((sums[v].area > 0 ? sums[v] : crossed[v]).irradiance());
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
      if (clustered(patch) || mesh_.walls.cross(mesh_.facets[f].triangle, mesh_.facets[f].code)) return;
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
  std::uint32_t side_;
  SurfaceVertices vertices_;
  std::vector<Vec3d> values_;
};

}  // namespace

Lattice make_lattice(const Mesh& mesh, std::span<const protocol::Flux> flux, double watts_per_quantum,
                     double unit_radiance) {
  const std::array<SideLight, 2> light{SideLight(mesh, flux, 0), SideLight(mesh, flux, 1)};
  const double factor = watts_per_quantum / (std::numbers::pi * unit_radiance);
  Lattice lattice;
  lattice.first.assign(mesh.facets.size(), 0);
  for (const MeshPatch& patch : mesh.patches) {
    for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
      lattice.first[f] = static_cast<std::uint32_t>(lattice.triangles.size());
      for (std::uint32_t side = 0; side < 2; ++side) {
        if (patch.side[side] == protocol::kNoSide) continue;
        protocol::LatticeTriangle& triangle = lattice.triangles.emplace_back();
        for (std::size_t c = 0; c < 3; ++c) {
          triangle.irradiance_over_pi[c] = to_float(vec::scale(light[side].at(light[side].corners(f)[c]), factor));
        }
      }
    }
  }
  return lattice;
}

}  // namespace torolux
