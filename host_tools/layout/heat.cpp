// SPDX-License-Identifier: MIT
// Goes through the sampled steps and adds up cycles: by subspace, by surface, or by owner where some subspaces are
// common. What no sample has met counts for half a visit.
#include "host_tools/layout/heat.hpp"

#include <optional>

namespace torolux {
namespace {

/// Visits of a cell that no sample has met: there may be some.
constexpr double kUnseen = 0.5;

}  // namespace

Heat heat_for(std::span<const std::vector<std::uint32_t>> polygons_of_cell) {
  Heat heat;
  heat.cycles_of_visit.reserve(polygons_of_cell.size());
  for (const auto& polygons : polygons_of_cell) {
    heat.cycles_of_visit.push_back(
        static_cast<float>(kHeatPerVisit + kHeatPerPolygon * static_cast<double>(polygons.size())));
  }
  return heat;
}

std::vector<double> heat_of_cells(const Heat& heat) {
  std::vector<double> visits(heat.cycles_of_visit.size());
  for (const Heat::Step& step : heat.steps) visits[step.cell] += static_cast<double>(step.records);
  for (std::size_t cell = 0; cell < visits.size(); ++cell) {
    const double seen = visits[cell] > 0 ? visits[cell] : kUnseen;
    visits[cell] = seen * (static_cast<double>(heat.cycles_of_visit[cell]) + kHeatPerHandOver);
  }
  return visits;
}

std::vector<double> heat_of_surfaces(const Heat& heat) {
  std::vector<double> cycles;
  cycles.reserve(heat.surfaces.size());
  for (const double seen : heat.surfaces) cycles.push_back((seen > 0 ? seen : kUnseen) * kHeatPerSurface);
  return cycles;
}

RemainingHeat remaining_heat(const Heat& heat, const std::vector<bool>& common) {
  RemainingHeat remaining;
  remaining.of_cell.resize(heat.cycles_of_visit.size());
  std::optional<CellIndex> holder;
  for (const Heat::Step& step : heat.steps) {
    const double records = static_cast<double>(step.records);
    if (step.first) holder.reset();
    if ((common.empty() || !common[step.cell]) && holder != step.cell) {
      holder = step.cell;
      remaining.of_cell[*holder] += records * kHeatPerHandOver;
    }
    const double cycles = records * static_cast<double>(heat.cycles_of_visit[step.cell]);
    (holder ? remaining.of_cell[*holder] : remaining.anywhere) += cycles;
  }
  return remaining;
}

}  // namespace torolux
