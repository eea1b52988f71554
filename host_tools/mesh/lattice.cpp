// SPDX-License-Identifier: MIT
// See lattice.hpp.
#include "host_tools/mesh/lattice.hpp"

#include <numbers>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/smooth_surfaces.hpp"

namespace torolux {
namespace {

using protocol::kMostLevels;

/// Flux and area of the elements around a vertex.
struct Sum {
  protocol::Flux flux{};
  double area = 0;

  void add(const protocol::Flux& more, double more_area) {
    for (std::size_t c = 0; c < 3; ++c) flux[c] += more[c];
    area += more_area;
  }
  Vec3d irradiance() const {
    if (!(area > 0)) return {0, 0, 0};
    return {static_cast<double>(flux[0]) / area, static_cast<double>(flux[1]) / area,
            static_cast<double>(flux[2]) / area};
  }
};

/// Where a lattice vertex of a triangle lies.
struct Place {
  enum class Kind : std::uint8_t { interior, corner, edge } kind = Kind::interior;
  std::uint32_t index = 0;  ///< of the corner or edge
  std::uint32_t along = 0;  ///< edge: steps of 2^-level from its first corner, 1 .. 2^level - 1
};

Place place_of(std::uint32_t i, std::uint32_t j, std::uint32_t level) {
  const std::uint32_t n = 1U << level;
  if (i == 0 && j == 0) return {Place::Kind::corner, 0, 0};
  if (i == n) return {Place::Kind::corner, 1, 0};
  if (j == n) return {Place::Kind::corner, 2, 0};
  if (j == 0) return {Place::Kind::edge, 0, i};
  if (i + j == n) return {Place::Kind::edge, 1, j};
  if (i == 0) return {Place::Kind::edge, 2, n - j};
  return {};
}

/// The sums of one side (front or back) of all triangles.
class SideLattice {
 public:
  SideLattice(const Mesh& mesh, const SmoothSurfaces& surfaces, std::uint32_t side)
      : mesh_(mesh), surfaces_(surfaces), side_(side) {
    const std::size_t nodes = 3 * mesh.triangles.size();
    corner_.resize(nodes);
    edge_first_.assign(nodes, 0);
    interior_first_.assign(mesh.triangles.size(), 0);
    std::size_t edges = 0;
    std::size_t interior = 0;
    for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
      if (!present(t)) continue;
      interior_first_[t] = interior;
      interior += protocol::lattice_size(mesh.triangles[t].element_level);
      for (std::uint32_t e = 0; e < 3; ++e) {
        const std::uint32_t node = surfaces.edge_node[t][e];
        if (node != 3 * t + e) continue;  // its root comes first
        edge_first_[node] = edges;
        edges += std::size_t{1} << surfaces.edge_level[node];
      }
    }
    edge_.resize(edges);
    interior_.resize(interior);
  }

  bool present(std::uint32_t t) const { return mesh_.triangles[t].first_element[side_] != protocol::kNoSide; }

  void take(std::uint32_t t, std::span<const protocol::Flux> flux) {
    const MeshTriangle& triangle = mesh_.triangles[t];
    const std::uint32_t level = triangle.element_level;
    const std::uint32_t count = protocol::triangles_of_level(level);
    const double area = triangle.area / count;
    for (std::uint32_t path = 0; path < count; ++path) {
      const protocol::GridTriangle grid = protocol::grid_triangle(path, level);
      for (const auto& corner : grid.corner) {
        const auto i = static_cast<std::uint32_t>(corner[1]) >> (kMostLevels - level);
        const auto j = static_cast<std::uint32_t>(corner[2]) >> (kMostLevels - level);
        if (Sum* sum = sum_at(t, i, j)) sum->add(flux[triangle.first_element[side_] + path], area);
      }
    }
  }

  /// Irradiance [quanta / user units^2].
  Vec3d irradiance(std::uint32_t t, std::uint32_t i, std::uint32_t j) {
    if (const Sum* sum = sum_at(t, i, j)) return sum->irradiance();
    const std::uint32_t level = mesh_.triangles[t].element_level;
    const Place place = place_of(i, j, level);
    const std::uint32_t step = 1U << (level - surfaces_.edge_level[surfaces_.edge_node[t][place.index]]);
    const std::uint32_t along = forward_steps(t, place);
    const Vec3d low = anchor(t, place.index, along / step);
    const Vec3d high = anchor(t, place.index, along / step + 1);
    const double fraction = static_cast<double>(along % step) / step;
    return {low[0] + (high[0] - low[0]) * fraction, low[1] + (high[1] - low[1]) * fraction,
            low[2] + (high[2] - low[2]) * fraction};
  }

 private:
  bool forward(std::uint32_t t, std::uint32_t edge) const {
    const auto& position = mesh_.triangles[t].position;
    return position[edge] < position[(edge + 1U) % 3U];
  }

  /// Steps from the edge's lower position, so that both triangles count alike.
  std::uint32_t forward_steps(std::uint32_t t, const Place& place) const {
    const std::uint32_t n = 1U << mesh_.triangles[t].element_level;
    return forward(t, place.index) ? place.along : n - place.along;
  }

  /// Null: a hanging vertex.
  Sum* sum_at(std::uint32_t t, std::uint32_t i, std::uint32_t j) {
    const std::uint32_t level = mesh_.triangles[t].element_level;
    const Place place = place_of(i, j, level);
    if (place.kind == Place::Kind::interior)
      return &interior_[interior_first_[t] + protocol::lattice_index(i, j, level)];
    if (place.kind == Place::Kind::corner) return &corner_[surfaces_.corner_node[t][place.index]];
    const std::uint32_t node = surfaces_.edge_node[t][place.index];
    const std::uint32_t step = 1U << (level - surfaces_.edge_level[node]);
    const std::uint32_t along = forward_steps(t, place);
    return along % step == 0 ? &edge_[edge_first_[node] + along / step] : nullptr;
  }

  /// The edge's coarse vertex `k`, 0 .. 2^edge_level, from the lower position.
  Vec3d anchor(std::uint32_t t, std::uint32_t edge, std::uint32_t k) const {
    const std::uint32_t node = surfaces_.edge_node[t][edge];
    const std::uint32_t first = forward(t, edge) ? edge : (edge + 1U) % 3U;
    const std::uint32_t last = forward(t, edge) ? (edge + 1U) % 3U : edge;
    if (k == 0) return corner_[surfaces_.corner_node[t][first]].irradiance();
    if (k == 1U << surfaces_.edge_level[node]) return corner_[surfaces_.corner_node[t][last]].irradiance();
    return edge_[edge_first_[node] + k].irradiance();
  }

  const Mesh& mesh_;
  const SmoothSurfaces& surfaces_;
  std::uint32_t side_;
  std::vector<Sum> corner_;
  std::vector<Sum> edge_;
  std::vector<Sum> interior_;
  std::vector<std::size_t> edge_first_;
  std::vector<std::size_t> interior_first_;
};

}  // namespace

Lattice make_lattice(const Mesh& mesh, std::span<const protocol::Flux> flux, double watts_per_quantum,
                     double unit_radiance) {
  const SmoothSurfaces surfaces = find_smooth_surfaces(mesh);
  std::array<SideLattice, 2> sides{SideLattice(mesh, surfaces, 0), SideLattice(mesh, surfaces, 1)};
  const auto triangles = static_cast<std::uint32_t>(mesh.triangles.size());
  for (SideLattice& side : sides) {
    for (std::uint32_t t = 0; t < triangles; ++t) {
      if (side.present(t)) side.take(t, flux);
    }
  }
  const double factor = watts_per_quantum / (std::numbers::pi * unit_radiance);
  Lattice lattice;
  lattice.first.assign(triangles, {protocol::kNoSide, protocol::kNoSide});
  for (std::uint32_t t = 0; t < triangles; ++t) {
    const std::uint32_t n = 1U << mesh.triangles[t].element_level;
    for (std::uint32_t s = 0; s < 2; ++s) {
      if (!sides[s].present(t)) continue;
      lattice.first[t][s] = static_cast<std::uint32_t>(lattice.values.size());
      for (std::uint32_t j = 0; j <= n; ++j) {
        for (std::uint32_t i = 0; i + j <= n; ++i) {
          const Vec3d irradiance = sides[s].irradiance(t, i, j);
          lattice.values.push_back(
              {{static_cast<float>(irradiance[0] * factor), static_cast<float>(irradiance[1] * factor),
                static_cast<float>(irradiance[2] * factor)}});
        }
      }
    }
  }
  return lattice;
}

}  // namespace torolux
