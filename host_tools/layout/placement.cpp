// SPDX-License-Identifier: MIT
// See placement.hpp.
#include "host_tools/layout/placement.hpp"

#include <algorithm>

#include "firmware/protocol/stores.hpp"

namespace torolux {
namespace {

using protocol::PeNumber;

/// Rough costs of a record in cycles, from a trial on paper (notes on load balance) and the latency table.
constexpr double kCyclesPerVisit = 600;
constexpr double kCyclesPerTest = 40;
constexpr double kCyclesPerRecordMade = 400;

std::vector<CellIndex> cells_of_patches(const Mesh& mesh, const Grid& grid) {
  std::vector<CellIndex> cells;
  cells.reserve(mesh.patches.size());
  for (const MeshPatch& patch : mesh.patches) cells.push_back(grid.index(grid.cell_of(to_float(patch.centre))));
  return cells;
}

/// What each cell is expected to cost in the radiosity stage.
std::vector<CellCost> predict(const Mesh& mesh, const Placement& placement, const std::vector<CellIndex>& patch_cell,
                              double records_per_patch) {
  const Grid& grid = placement.grid;
  const double records = records_per_patch * static_cast<double>(mesh.patches.size());
  const double crossed = 0.75 * (grid.cells[0] + grid.cells[1] + grid.cells[2]) / 1.5;
  const double visits = records * crossed / grid.count();
  std::vector<CellCost> costs(grid.count());
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    const auto polygons = static_cast<double>(placement.polygons_of_cell[cell].size());
    costs[cell].cycles = static_cast<std::uint64_t>(visits * (kCyclesPerVisit + kCyclesPerTest * polygons));
    costs[cell].bytes = sizeof(protocol::Subspace);
    for (const std::uint32_t t : placement.polygons_of_cell[cell]) {
      const MeshTriangle& triangle = mesh.triangles[t];
      costs[cell].bytes +=
          sizeof(protocol::Polygon) + sizeof(std::uint32_t) + triangle.facets * sizeof(protocol::LatticeTriangle);
    }
  }
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    const MeshPatch& patch = mesh.patches[p];
    CellCost& cost = costs[patch_cell[p]];
    cost.cycles += static_cast<std::uint64_t>(records_per_patch * kCyclesPerRecordMade);
    cost.bytes += sizeof(protocol::Patch) + patch.facets * sizeof(protocol::Facet);
    for (const std::uint32_t side : patch.side) {
      if (side == protocol::kNoSide) continue;
      cost.bytes += sizeof(protocol::PatchSide) + patch.elements * sizeof(protocol::Element);
    }
  }
  return costs;
}

void spread(const Mesh& mesh, const std::vector<CellIndex>& patch_cell, bool stop_everywhere, Placement& placement) {
  const unsigned pes = placement.torus.pes();
  placement.cells_of_pe.resize(pes);
  placement.polygons_of_pe.resize(pes);
  placement.patches_of_pe.resize(pes);
  for (CellIndex cell = 0; cell < placement.grid.count(); ++cell) {
    const auto& polygons = placement.polygons_of_cell[cell];
    if (!polygons.empty()) ++placement.filled_cells;
    placement.stop_cell.push_back(stop_everywhere || !polygons.empty());
    if (!placement.stop_cell.back()) continue;
    ++placement.stops;
    for (unsigned pe = 0; pe < pes; ++pe) {
      if (!placement.common_cell[cell] && placement.pe_of_cell[cell] != pe) continue;
      placement.cells_of_pe[pe].push_back(cell);
      placement.polygons_of_pe[pe].insert(placement.polygons_of_pe[pe].end(), polygons.begin(), polygons.end());
    }
  }
  for (std::uint32_t patch = 0; patch < mesh.patches.size(); ++patch) {
    const CellIndex cell = patch_cell[patch];
    const PeNumber pe = placement.pe_of_cell[cell];
    placement.patch_home.push_back({pe, static_cast<std::uint32_t>(placement.patches_of_pe[pe].size()), cell});
    placement.patches_of_pe[pe].push_back(patch);
    // Its owner shoots from all of a patch, though a cluster's triangles may lie beyond the owner's subspaces.
    for (std::uint32_t f = 0; f < mesh.patches[patch].facets; ++f) {
      placement.polygons_of_pe[pe].push_back(mesh.facets[mesh.patches[patch].first_facet + f].triangle);
    }
  }
  for (auto& polygons : placement.polygons_of_pe) {
    std::sort(polygons.begin(), polygons.end());
    polygons.erase(std::unique(polygons.begin(), polygons.end()), polygons.end());
  }
}

}  // namespace

Placement make_placement(const Mesh& mesh, const PlacementChoice& choice) {
  Placement placement;
  placement.torus = choice.torus;
  placement.grid = make_grid(mesh.space, choice.subspaces, mesh.triangles.size(), choice.torus.pes());
  placement.polygons_of_cell = polygons_by_cell(placement.grid, mesh.triangles);
  const std::vector<CellIndex> patch_cell = cells_of_patches(mesh, placement.grid);
  const std::vector<CellCost> costs = predict(mesh, placement, patch_cell, choice.records_per_patch);
  placement.pe_of_cell = allocate(choice.allocation, placement.grid, placement.torus, costs);
  placement.common_cell.assign(placement.grid.count(), choice.copy_all);
  spread(mesh, patch_cell, choice.stop_everywhere, placement);
  return placement;
}

}  // namespace torolux
