// SPDX-License-Identifier: MIT
// Subspaces go by the allocation. With `balanced`, patches that do not stay with their subspace fill up the PEs that
// have least to do, row by row, there and back.
#include "host_tools/layout/owners.hpp"

#include <algorithm>
#include <numeric>

#include "host_tools/layout/copies.hpp"
#include "host_tools/layout/golden_step.hpp"

namespace torolux {
namespace {

using protocol::PeNumber;
using protocol::Stage;

/// Of what a patch receives: as if light came evenly to all elements, in place of what the samples say. It evens out
/// their chance, and keeps the PEs' memory alike: nobody owns more than twice its part of the elements.
constexpr double kEvenly = 0.5;

std::uint64_t patch_bytes(const MeshPatch& patch) {
  // As if it were of one part; every four children add three leaves.
  std::uint64_t bytes = sizeof(protocol::Patch) + sizeof(protocol::PatchPart) +
                        patch.facets / 3 * 4 * sizeof(std::uint32_t) + patch.facets * sizeof(protocol::Facet);
  for (const std::uint32_t side : patch.side) {
    if (side != protocol::kNoSide) bytes += sizeof(protocol::PatchSide) + patch.elements * sizeof(protocol::Element);
  }
  return bytes;
}

/// By patch; > 0.
std::vector<double> cycles_of_patches(const Mesh& mesh, const Heat* heat) {
  double deposits = 0;
  double elements = 0;
  for (const MeshPatch& patch : mesh.patches) elements += patch.elements;
  const bool sampled = heat != nullptr && !heat->deposits.empty();
  if (sampled) deposits = std::accumulate(heat->deposits.begin(), heat->deposits.end(), 0.0);
  std::vector<double> cycles;
  cycles.reserve(mesh.patches.size());
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) {
    const double part = mesh.patches[p].elements / elements;
    if (deposits > 0) {
      cycles.push_back((1 - kEvenly) * heat->deposits[p] + kEvenly * deposits * part);
    } else {
      cycles.push_back(part);
    }
  }
  return cycles;
}

/// The level to which the PEs are full when `more` has been poured in: nobody who was fuller gets any.
double level_of(std::vector<double> loads, double more) {
  std::sort(loads.begin(), loads.end());
  double below = 0;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    below += loads[i];
    const double level = (below + more) / static_cast<double>(i + 1);
    if (i + 1 == loads.size() || level <= loads[i + 1]) return level;
  }
  return 0;
}

/// PEs row by row, there and back: the next one is always a neighbour.
std::vector<PeNumber> winding(const TorusSize& torus) {
  std::vector<PeNumber> order;
  for (unsigned row = 0; row < torus.rows; ++row) {
    for (unsigned i = 0; i < torus.columns; ++i) {
      const unsigned column = row % 2 == 0 ? i : torus.columns - 1 - i;
      order.push_back(static_cast<PeNumber>(row * torus.columns + column));
    }
  }
  return order;
}

class Balanced {
 public:
  Balanced(const Mesh& mesh, const Placement& placement, const std::vector<CellIndex>& patch_cell,
           const StageLoad& load)
      : mesh_(mesh), placement_(placement), patch_cell_(patch_cell), load_(load), costs_(placement.grid.count()) {
    if (load.heat != nullptr) cell_cycles_ = remaining_heat(*load.heat, placement.common_cell).of_cell;
    cell_cycles_.resize(placement.grid.count());
    if (has_patches()) patch_cycles_ = cycles_of_patches(mesh, load.heat);
  }

  Owners owners() {
    add_cells();
    choose_patches_that_stay();
    Owners owners;
    owners.of_cell = allocate("balanced", placement_.grid, placement_.torus, costs_, load_.most_memory);
    if (has_patches()) owners.of_patch = patches(owners.of_cell);
    return owners;
  }

 private:
  bool has_patches() const { return load_.stage == Stage::radiosity; }
  bool is_held(CellIndex cell) const { return !placement_.common_cell[cell] && placement_.stop_cell[cell]; }

  void add_cells() {
    for (CellIndex cell = 0; cell < placement_.grid.count(); ++cell) {
      if (!is_held(cell)) continue;
      costs_[cell].cycles = cell_cycles_[cell];
      costs_[cell].bytes = cell_bytes(placement_.polygons_of_cell[cell].size());
      for (const std::uint32_t t : placement_.polygons_of_cell[cell])
        costs_[cell].bytes += load_.common_surface.empty() ? polygon_bytes(mesh_.triangles[t], load_.stage)
                                                           : shape_bytes(mesh_, mesh_.triangles[t], load_.stage);
    }
  }

  void choose_patches_that_stay() {
    if (!has_patches()) return;
    std::vector<double> with_patches = cell_cycles_;
    for (std::size_t p = 0; p < patch_cell_.size(); ++p) with_patches[patch_cell_[p]] += patch_cycles_[p];
    const double mean = std::accumulate(with_patches.begin(), with_patches.end(), 0.0) / placement_.torus.pes();
    stays_.resize(patch_cell_.size());
    for (std::size_t p = 0; p < patch_cell_.size(); ++p) {
      const CellIndex cell = patch_cell_[p];
      stays_[p] = placement_.scheme == Scheme::paper || (is_held(cell) && with_patches[cell] <= mean);
      if (!stays_[p]) continue;
      costs_[cell].cycles += patch_cycles_[p];
      costs_[cell].bytes += patch_bytes(mesh_.patches[p]);
    }
  }

  std::vector<PeNumber> patches(const std::vector<PeNumber>& pe_of_cell) const {
    std::vector<double> loads(placement_.torus.pes());
    for (CellIndex cell = 0; cell < costs_.size(); ++cell) loads[pe_of_cell[cell]] += costs_[cell].cycles;
    double rest = 0;
    for (std::size_t p = 0; p < stays_.size(); ++p) rest += stays_[p] ? 0 : patch_cycles_[p];
    const double level = level_of(loads, rest);
    const std::vector<PeNumber> order = winding(placement_.torus);
    std::vector<PeNumber> homes(stays_.size());
    std::size_t at = 0;
    double until = std::max(0.0, level - loads[order[0]]);
    double given = 0;
    // Neighbours shoot in the same rounds, so that their owners, who make their points, should be many.
    const std::uint64_t step = golden_step(stays_.size());
    for (std::size_t i = 0; i < stays_.size(); ++i) {
      const std::size_t p = i * step % stays_.size();
      if (stays_[p]) {
        homes[p] = pe_of_cell[patch_cell_[p]];
        continue;
      }
      const double middle = given + patch_cycles_[p] / 2;
      given += patch_cycles_[p];
      while (middle > until && at + 1 < order.size()) until += std::max(0.0, level - loads[order[++at]]);
      homes[p] = order[at];
    }
    return homes;
  }

  const Mesh& mesh_;
  const Placement& placement_;
  const std::vector<CellIndex>& patch_cell_;
  const StageLoad& load_;
  std::vector<CellCost> costs_;
  std::vector<double> cell_cycles_, patch_cycles_;
  std::vector<bool> stays_;  ///< by patch
};

}  // namespace

std::vector<CellIndex> cells_of_patches(const Mesh& mesh, const Grid& grid) {
  std::vector<CellIndex> cells;
  cells.reserve(mesh.patches.size());
  for (const MeshPatch& patch : mesh.patches) cells.push_back(grid.index(grid.cell_of(to_float(patch.centre))));
  return cells;
}

Owners choose_owners(const Mesh& mesh, const Placement& placement, const std::vector<CellIndex>& patch_cell,
                     std::string_view allocation, const StageLoad& load) {
  if (allocation == "balanced") return Balanced(mesh, placement, patch_cell, load).owners();
  Owners owners;
  owners.of_cell = allocate(allocation, placement.grid, placement.torus, {});
  if (load.stage == Stage::ray_tracing) return owners;
  for (const CellIndex cell : patch_cell) owners.of_patch.push_back(owners.of_cell[cell]);
  return owners;
}

}  // namespace torolux
