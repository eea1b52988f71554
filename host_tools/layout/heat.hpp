// SPDX-License-Identifier: MIT
// Ways of some light that was followed on the host (host_tools/setup/sample_heat) enter; leaves: how much work each
// subspace, surface and patch causes in a stage. For copies and allocation; no picture depends on it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/subspace/grid.hpp"

namespace torolux {

/// Rough costs in cycles of pe.elf, as fitted for host_tools/render/predict.cpp: only their proportions matter.
inline constexpr double kHeatPerVisit = 560;   ///< of a subspace
inline constexpr double kHeatPerPolygon = 46;  ///< in its list: its box, and a test of three in ten
inline constexpr double kHeatPerHandOver = 1170;
inline constexpr double kHeatPerSurface = kHeatPerHandOver + 1430;  ///< seen, and handed over for it
inline constexpr double kHeatPerDeposit = 250;                      ///< at the patch's owner, sent by another PE

/// Ways of records through subspaces that were followed as samples of a stage, one after the other.
struct Heat {
  struct Step {
    CellIndex cell;
    float records;  ///< that this way stands for
    bool first;     ///< of its record
  };
  std::vector<Step> steps;
  std::vector<float> cycles_of_visit;  ///< by cell
  std::vector<double> surfaces;        ///< by part of the mesh: records that see it. Radiosity stage: empty
  std::vector<double> deposits;        ///< by patch: cycles at its owner. Ray tracing stage: empty

  bool empty() const { return steps.empty(); }
};

/// A heat without steps for these lists of polygons.
Heat heat_for(std::span<const std::vector<std::uint32_t>> polygons_of_cell);

/// By cell: cycles of all visits, each handed over. A cell that no sample has met counts for half a visit.
std::vector<double> heat_of_cells(const Heat& heat);

/// By part: cycles of all that see it, each handed over. One that no sample has seen counts for half of one.
std::vector<double> heat_of_surfaces(const Heat& heat);

/// What of it the owners of cells do, if those marked stand on every PE. A record that has been handed over is followed
/// where it then is, through common cells too, until it comes to another owner's cell.
struct RemainingHeat {
  std::vector<double> of_cell;  ///< at its owner; 0 for common cells
  double anywhere = 0;          ///< in common cells, at whichever PE has made the record
};
/// common: by cell, or empty: none.
RemainingHeat remaining_heat(const Heat& heat, const std::vector<bool>& common);

}  // namespace torolux
