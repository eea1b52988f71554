// SPDX-License-Identifier: MIT
// Who owns which subspace and which patch: heat, common cells and an allocation's name enter, PEs leave.
#pragma once

#include <string_view>
#include <vector>

#include "host_tools/layout/placement.hpp"

namespace torolux {

std::vector<CellIndex> cells_of_patches(const Mesh& mesh, const Grid& grid);

struct Owners {
  std::vector<protocol::PeNumber> of_cell;
  std::vector<protocol::PeNumber> of_patch;  ///< ray tracing stage: empty
};

/// Of placement: torus, grid, scheme, lists, stops and common cells. `balanced`: the cell that leaves its owner most to
/// do first, each to the PE that has least to do, of equal ones to the nearest of its neighbours. With a cell go the
/// patches that have their centres in it. Scheme `spread`: but for those of common cells and of cells at which no
/// ray stops, and of such cells as would be too much for one PE: they fill up what the PEs lack, in the mesh's order,
/// so that a PE has patches that lie near each other. Other allocations: a patch lives with its cell. Throws
/// UsageError: unknown allocation.
Owners choose_owners(const Mesh& mesh, const Placement& placement, const std::vector<CellIndex>& patch_cell,
                     std::string_view allocation, const StageLoad& load);

}  // namespace torolux
