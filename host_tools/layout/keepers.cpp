// SPDX-License-Identifier: MIT
// See keepers.hpp.
#include "host_tools/layout/keepers.hpp"

#include <algorithm>
#include <queue>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/copies.hpp"

namespace torolux {
namespace {

using protocol::PeNumber;

/// A surface to be kept: its share of all that are kept, in work and in memory.
struct Kept {
  double load;
  std::uint32_t part;
};

struct Keeper {
  double load;
  PeNumber pe;
  bool operator<(const Keeper& other) const {
    return load != other.load ? load > other.load : pe > other.pe;  // the least loaded is on top
  }
};

std::vector<Kept> surfaces_to_keep(const Mesh& mesh, const StageLoad& load, Placement& placement, double& bytes) {
  const std::vector<double> heat = load.heat != nullptr ? heat_of_surfaces(*load.heat) : std::vector<double>();
  std::vector<std::uint32_t> parts;
  double cycles = 0;
  const auto& polygons = placement.polygons_of_pe.front();
  for (std::uint32_t local = 0; local < placement.common_polygons; ++local) {
    const MeshTriangle& triangle = mesh.triangles[polygons[local]];
    if (triangle.sides == 0) continue;
    const std::uint32_t end = triangle.first_part + protocol::triangles_of_level(triangle.patch_level);
    for (std::uint32_t part = triangle.first_part; part < end; ++part) {
      if (load.common_surface[part]) continue;
      const SurfaceSize size = surface_size(mesh, part);
      placement.kept_surfaces.nodes += size.nodes;
      placement.kept_surfaces.lattice += size.lattice;
      if (!heat.empty()) cycles += heat[part];
      parts.push_back(part);
    }
  }
  bytes = static_cast<double>(placement.kept_surfaces.bytes());
  std::vector<Kept> kept;
  for (const std::uint32_t part : parts) {
    const double memory = static_cast<double>(surface_size(mesh, part).bytes()) / bytes;
    kept.push_back({memory + (cycles > 0 ? heat[part] / cycles : 0), part});
  }
  return kept;
}

/// What each PE has of its own besides, in the same measure.
double own_bytes(const Mesh& mesh, const Placement& placement, std::size_t pe) {
  double bytes = 0;
  const auto& polygons = placement.polygons_of_pe[pe];
  for (std::size_t i = placement.common_polygons; i < polygons.size(); ++i) {
    bytes += static_cast<double>(polygon_bytes(mesh.triangles[polygons[i]], protocol::Stage::ray_tracing));
  }
  return bytes;
}

}  // namespace

SurfaceSize surface_size(const Mesh& mesh, std::uint32_t part) {
  const MeshTriangle& triangle = mesh.triangles[mesh.facets[mesh.parts[part].facet].triangle];
  const std::uint32_t last = triangle.first_part + protocol::triangles_of_level(triangle.patch_level) - 1;
  const std::uint32_t end =
      part == last ? mesh.parts[triangle.first_part].facet + triangle.facets : mesh.parts[part + 1].facet;
  const std::uint32_t facets = end - mesh.parts[part].facet;
  // Every four children add three leaves.
  return {(facets - 1) / 3 * 4, facets * triangle.side_count()};
}

void keep_surfaces(const Mesh& mesh, const StageLoad& load, Placement& placement) {
  double bytes = 0;
  std::vector<Kept> kept = surfaces_to_keep(mesh, load, placement, bytes);
  if (kept.empty()) return;
  std::stable_sort(kept.begin(), kept.end(), [](const Kept& a, const Kept& b) { return a.load > b.load; });
  placement.keeper_of_part.assign(mesh.parts.size(), protocol::kNobody);
  placement.place_of_part.resize(mesh.parts.size());
  std::priority_queue<Keeper> keepers;
  for (unsigned pe = 0; pe < placement.torus.pes(); ++pe) {
    keepers.push({own_bytes(mesh, placement, pe) / bytes, static_cast<PeNumber>(pe)});
  }
  for (const Kept& surface : kept) {
    Keeper keeper = keepers.top();
    keepers.pop();
    std::vector<std::uint32_t>& list = placement.kept_by_pe[keeper.pe];
    placement.keeper_of_part[surface.part] = keeper.pe;
    placement.place_of_part[surface.part] = static_cast<std::uint32_t>(list.size());
    list.push_back(surface.part);
    keeper.load += surface.load;
    keepers.push(keeper);
  }
}

}  // namespace torolux
