// SPDX-License-Identifier: MIT
// Where everything of a scene lives in the machine: subspaces, polygons and patches by PE.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "firmware/protocol/machine.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/subspace/allocation.hpp"
#include "host_tools/subspace/grid.hpp"

namespace torolux {

struct PatchHome {
  protocol::PeNumber pe = 0;
  std::uint32_t local = 0;  ///< local number at `pe`
  CellIndex cell = 0;       ///< that holds its centre
};

struct Placement {
  TorusSize torus;
  Grid grid;
  std::vector<std::vector<std::uint32_t>> polygons_of_cell;  ///< ascending
  std::vector<protocol::PeNumber> pe_of_cell;
  std::vector<bool> stop_cell;                             ///< where a ray must stop: by cell
  std::uint32_t stops = 0;                                 ///< of those
  std::vector<bool> common_cell;                           ///< that stand on every PE: by cell
  std::vector<std::vector<CellIndex>> cells_of_pe;         ///< ascending, those at which rays stop: local number -> cell
  std::vector<std::vector<std::uint32_t>> polygons_of_pe;  ///< ascending: local number -> triangle
  std::vector<std::vector<std::uint32_t>> patches_of_pe;   ///< ascending: local number -> global patch
  std::vector<PatchHome> patch_home;                       ///< by global patch
  std::uint64_t filled_cells = 0;
};

struct PlacementChoice {
  TorusSize torus;
  std::optional<std::array<std::uint32_t, 3>> subspaces;
  std::string allocation = "skewed";
  bool copy_all = false;
  bool stop_everywhere = false;    ///< rays stop in empty subspaces, too: every face crossed is a hand-over
  double records_per_patch = 12288;  ///< expected in the radiosity stage; for `balanced` only
};

/// Throws UsageError: unknown allocation, grid out of range.
Placement make_placement(const Mesh& mesh, const PlacementChoice& choice);

}  // namespace torolux
