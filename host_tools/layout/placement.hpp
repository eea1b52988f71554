// SPDX-License-Identifier: MIT
// Mesh, machine and a stage's load enter; where everything of a scene lives leaves: subspaces, polygons and patches by
// PE.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/protocol/machine.hpp"
#include "firmware/protocol/stores.hpp"
#include "host_tools/layout/heat.hpp"
#include "host_tools/layout/polygon_groups.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/settings/scheme.hpp"
#include "host_tools/subspace/allocation.hpp"
#include "host_tools/subspace/grid.hpp"

namespace torolux {

struct PatchHome {
  protocol::PeNumber pe = 0;
  std::uint32_t local = 0;  ///< local number at `pe`
  CellIndex cell = 0;       ///< that holds its centre; not always one of the PE's
};

/// Of a part of a polygon, ray tracing stage: entries in the stores for what is seen on it.
struct SurfaceSize {
  std::uint32_t nodes = 0, irradiance = 0;

  SurfaceSize& operator+=(const SurfaceSize& other) {
    nodes += other.nodes;
    irradiance += other.irradiance;
    return *this;
  }
  std::uint64_t bytes() const {
    return std::uint64_t{nodes} * sizeof(std::uint32_t) +
           std::uint64_t{irradiance} * sizeof(protocol::CornerIrradiance);
  }
};

/// Of one stage, or (scheme `paper` without copies) of both.
struct Placement {
  TorusSize torus;
  Grid grid;
  Scheme scheme = Scheme::paper;
  std::vector<std::vector<std::uint32_t>> polygons_of_cell;  ///< ascending
  /// As PEs list them; ListedPolygon::polygon is a triangle of the mesh.
  std::vector<std::vector<protocol::ListedPolygon>> entries_of_cell;
  /// Of a common cell, and of one that nobody holds: any PE.
  std::vector<protocol::PeNumber> pe_of_cell;
  std::vector<bool> stop_cell;               ///< by cell: a ray must stop there. Empty::enter: everywhere
  std::uint32_t stops = 0;                   ///< such cells
  std::vector<bool> common_cell;             ///< by cell: it stands on every PE
  std::vector<std::uint32_t> local_of_cell;  ///< where it is held
  /// Local number -> cell: the common ones, ascending, then the PE's own, ascending. Nobody holds cells
  /// at which no ray stops.
  std::vector<std::vector<CellIndex>> cells_of_pe;
  std::uint32_t common_cells = 0;
  /// Local number -> triangle: those of common cells, ascending, then what else the PE needs, ascending.
  std::vector<std::vector<std::uint32_t>> polygons_of_pe;
  std::uint32_t common_polygons = 0;
  /// Ray tracing stage, by part of the mesh: who alone has its surface, or kNobody: every PE that has its polygon.
  /// Empty: kNobody for all.
  std::vector<protocol::PeNumber> keeper_of_part;
  std::vector<std::uint32_t> place_of_part;               ///< where one is kept, among those of its keeper
  std::vector<std::vector<std::uint32_t>> kept_by_pe;     ///< parts, by place
  std::vector<SurfaceSize> surfaces_with_keepers;         ///< by PE: of its polygons, whoever keeps them
  SurfaceSize common_surfaces_with_keepers;               ///< the same of common polygons
  std::vector<std::vector<std::uint32_t>> patches_of_pe;  ///< ascending: local number -> global patch
  std::vector<PatchHome> patch_home;                      ///< by global patch
  std::vector<std::vector<std::uint32_t>> parts_of_pe;    ///< of those patches, ascending: local -> Mesh::parts
  std::vector<std::uint32_t> local_of_part;               ///< by part: at its patch's owner
  std::uint64_t filled_cells = 0;

  /// Absent: the PE does not have it.
  std::optional<std::uint32_t> local_polygon(protocol::PeNumber pe, std::uint32_t triangle) const;
  /// Or every PE has the part's surface that has its polygon.
  bool has_keeper(std::uint32_t part) const {
    return !keeper_of_part.empty() && keeper_of_part[part] != protocol::kNobody;
  }
  /// The same with one PE more behind the others, which has what all have, and nothing of its own.
  Placement with_nobody() const;
  /// PEs without a cell with anything in it and without a patch.
  std::uint32_t idle_pes() const;
};

struct PlacementChoice {
  TorusSize torus;
  std::optional<std::array<std::uint32_t, 3>> subspaces;
  std::string allocation = "skewed";
  Scheme scheme = Scheme::paper;
  Empty empty = empty_of(scheme);
};

/// What stands in each cell of a grid: `polygons_of_cell` and `entries_of_cell` of all placements on it.
struct CellLists {
  Grid grid;
  std::vector<std::vector<std::uint32_t>> polygons;
  std::vector<std::vector<protocol::ListedPolygon>> entries;
};
CellLists list_cells(const Mesh& mesh, const Grid& grid);

/// What a placement is made for.
struct StageLoad {
  protocol::Stage stage = protocol::Stage::radiosity;
  const Heat* heat = nullptr;          ///< for `balanced`; null: by memory alone
  std::vector<bool> common_cell = {};  ///< empty: none
  /// Ray tracing stage, by part of the mesh: its surface stands wherever its polygon does. Empty: all.
  std::vector<bool> common_surface = {};
  /// `balanced` gives a PE at most so many times the mean of its own memory, but what is owned by one cell.
  double most_memory = kMostMemory;
};

/// Throws UsageError: unknown allocation, grid out of range.
Placement make_placement(const Mesh& mesh, const PlacementChoice& choice);
/// The same on a grid whose lists are known.
Placement make_placement(const Mesh& mesh, const CellLists& lists, const PlacementChoice& choice,
                         const StageLoad& load);

}  // namespace torolux
