// SPDX-License-Identifier: MIT
// Lists by PE are put together from the owners (owners.hpp): first what all PEs have alike, then what each has of its
// own; at last the keepers (keepers.hpp).
#include "host_tools/layout/placement.hpp"

#include <algorithm>
#include <type_traits>
#include <utility>

#include "firmware/protocol/stores.hpp"
#include "host_tools/layout/keepers.hpp"
#include "host_tools/layout/owners.hpp"

namespace torolux {
namespace {

using protocol::PeNumber;

void sort_unique(std::vector<std::uint32_t>& numbers, std::size_t from) {
  const auto begin = numbers.begin() + static_cast<std::ptrdiff_t>(from);
  std::sort(begin, numbers.end());
  numbers.erase(std::unique(begin, numbers.end()), numbers.end());
}

/// Subspaces and their polygons.
void spread_cells(Placement& placement) {
  const unsigned pes = placement.torus.pes();
  std::vector<CellIndex> common;
  std::vector<std::uint32_t> polygons;
  placement.local_of_cell.resize(placement.grid.count());
  for (CellIndex cell = 0; cell < placement.grid.count(); ++cell) {
    const auto& of_cell = placement.polygons_of_cell[cell];
    if (!placement.common_cell[cell]) continue;
    placement.local_of_cell[cell] = static_cast<std::uint32_t>(common.size());
    common.push_back(cell);
    polygons.insert(polygons.end(), of_cell.begin(), of_cell.end());
  }
  sort_unique(polygons, 0);
  placement.common_cells = static_cast<std::uint32_t>(common.size());
  placement.common_polygons = static_cast<std::uint32_t>(polygons.size());
  placement.cells_of_pe.assign(pes, common);
  placement.polygons_of_pe.assign(pes, polygons);
  for (CellIndex cell = 0; cell < placement.grid.count(); ++cell) {
    const auto& of_cell = placement.polygons_of_cell[cell];
    if (placement.common_cell[cell] || !placement.stop_cell[cell]) continue;
    const PeNumber pe = placement.pe_of_cell[cell];
    placement.local_of_cell[cell] = static_cast<std::uint32_t>(placement.cells_of_pe[pe].size());
    placement.cells_of_pe[pe].push_back(cell);
    placement.polygons_of_pe[pe].insert(placement.polygons_of_pe[pe].end(), of_cell.begin(), of_cell.end());
  }
}

/// Patches, and polygons that only they bring.
void spread_patches(const Mesh& mesh, const std::vector<CellIndex>& patch_cell, const std::vector<PeNumber>& homes,
                    Placement& placement) {
  placement.patches_of_pe.resize(placement.torus.pes());
  for (std::uint32_t patch = 0; patch < homes.size(); ++patch) {
    const PeNumber pe = homes[patch];
    const auto local = static_cast<std::uint32_t>(placement.patches_of_pe[pe].size());
    placement.patch_home.push_back({pe, local, patch_cell[patch]});
    placement.patches_of_pe[pe].push_back(patch);
    // Its owner shoots from all of a patch, though a cluster's triangles may lie beyond the owner's subspaces.
    for (std::uint32_t f = 0; f < mesh.patches[patch].facets; ++f) {
      placement.polygons_of_pe[pe].push_back(mesh.facets[mesh.patches[patch].first_facet + f].triangle);
    }
  }
}

/// Ray tracing stage: no patches.
void spread_parts(const Mesh& mesh, Placement& placement) {
  placement.parts_of_pe.resize(placement.torus.pes());
  if (placement.patch_home.empty()) return;
  for (std::uint32_t part = 0; part < mesh.parts.size(); ++part) {
    std::vector<std::uint32_t>& parts = placement.parts_of_pe[placement.patch_home[mesh.parts[part].patch].pe];
    placement.local_of_part.push_back(static_cast<std::uint32_t>(parts.size()));
    parts.push_back(part);
  }
}

/// Leaves behind the common polygons those that are not among them.
void order_polygons(Placement& placement) {
  for (auto& polygons : placement.polygons_of_pe) {
    const auto own = polygons.begin() + placement.common_polygons;
    const auto is_common = [&](std::uint32_t t) { return std::binary_search(polygons.begin(), own, t); };
    polygons.erase(std::remove_if(own, polygons.end(), is_common), polygons.end());
    sort_unique(polygons, placement.common_polygons);
  }
}

}  // namespace

std::optional<std::uint32_t> Placement::local_polygon(PeNumber pe, std::uint32_t triangle) const {
  const std::vector<std::uint32_t>& polygons = polygons_of_pe[pe];
  const auto own = polygons.begin() + common_polygons;
  for (const auto& [begin, end] : {std::pair(polygons.begin(), own), std::pair(own, polygons.end())}) {
    const auto found = std::lower_bound(begin, end, triangle);
    if (found != end && *found == triangle) return static_cast<std::uint32_t>(found - polygons.begin());
  }
  return std::nullopt;
}

Placement Placement::with_nobody() const {
  Placement more = *this;
  const auto first = [](const auto& list, std::uint32_t count) {
    return std::remove_cvref_t<decltype(list)>(list.begin(), list.begin() + count);
  };
  more.cells_of_pe.push_back(first(cells_of_pe.front(), common_cells));
  more.polygons_of_pe.push_back(first(polygons_of_pe.front(), common_polygons));
  more.patches_of_pe.emplace_back();
  more.parts_of_pe.emplace_back();
  more.kept_by_pe.emplace_back();
  if (!surfaces_with_keepers.empty()) more.surfaces_with_keepers.push_back(common_surfaces_with_keepers);
  return more;
}

std::uint32_t Placement::idle_pes() const {
  std::uint32_t idle = 0;
  for (unsigned pe = 0; pe < torus.pes(); ++pe) {
    if (polygons_of_pe[pe].empty() && patches_of_pe[pe].empty()) ++idle;
  }
  return idle;
}

CellLists list_cells(const Mesh& mesh, const Grid& grid) {
  CellLists lists{grid, polygons_by_cell(grid, mesh.triangles), {}};
  for (CellIndex cell = 0; cell < grid.count(); ++cell) {
    lists.entries.push_back(list_polygons(mesh.triangles, lists.polygons[cell], grid, cell));
  }
  return lists;
}

Placement make_placement(const Mesh& mesh, const CellLists& lists, const PlacementChoice& choice,
                         const StageLoad& load) {
  const Grid& grid = lists.grid;
  Placement placement;
  placement.torus = choice.torus;
  placement.grid = grid;
  placement.scheme = choice.scheme;
  placement.polygons_of_cell = lists.polygons;
  placement.entries_of_cell = lists.entries;
  for (const auto& of_cell : placement.polygons_of_cell) {
    if (!of_cell.empty()) ++placement.filled_cells;
    placement.stop_cell.push_back(choice.empty == Empty::enter || !of_cell.empty());
    if (placement.stop_cell.back()) ++placement.stops;
  }
  placement.common_cell = load.common_cell;
  placement.common_cell.resize(grid.count());
  const std::vector<CellIndex> patch_cell = cells_of_patches(mesh, grid);
  const Owners owners = choose_owners(mesh, placement, patch_cell, choice.allocation, load);
  placement.pe_of_cell = owners.of_cell;
  spread_cells(placement);
  spread_patches(mesh, patch_cell, owners.of_patch, placement);
  spread_parts(mesh, placement);
  order_polygons(placement);
  placement.kept_by_pe.resize(placement.torus.pes());
  if (!load.common_surface.empty()) keep_surfaces(mesh, load, placement);
  return placement;
}

Placement make_placement(const Mesh& mesh, const PlacementChoice& choice) {
  const Grid grid = make_grid(mesh.space, choice.subspaces, mesh.triangles.size(), choice.torus.pes());
  return make_placement(mesh, list_cells(mesh, grid), choice, {});
}

}  // namespace torolux
