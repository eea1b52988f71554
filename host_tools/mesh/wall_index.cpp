// SPDX-License-Identifier: MIT
// Each wall is put into the cells that it passes through, row by row.
#include "host_tools/mesh/wall_index.hpp"

#include <algorithm>
#include <cmath>

namespace torolux {
namespace {

/// More than rounding, in weights: so far beyond its cells a wall is looked for.
constexpr double kRounding = 1e-7;
constexpr double kMostCells = 256;

}  // namespace

std::uint32_t WallIndex::cell_at(double weight) const {
  const double at = std::floor(weight * cells_);
  return static_cast<std::uint32_t>(std::clamp(at, 0.0, static_cast<double>(cells_ - 1)));
}

WallIndex::Range WallIndex::cells_of(std::span<const PlanePoint> points) const {
  PlanePoint low = points[0];
  PlanePoint high = points[0];
  for (const PlanePoint& point : points) {
    low = {std::min(low.b1, point.b1), std::min(low.b2, point.b2)};
    high = {std::max(high.b1, point.b1), std::max(high.b2, point.b2)};
  }
  return {cell_at(low.b1 - kRounding), cell_at(high.b1 + kRounding), cell_at(low.b2 - kRounding),
          cell_at(high.b2 + kRounding)};
}

WallIndex::WallIndex(const std::array<std::span<const WallSegment>, 2>& walls) {
  const double count = static_cast<double>(walls[0].size() + walls[1].size());
  cells_ = static_cast<std::uint32_t>(std::clamp(std::sqrt(count), 1.0, kMostCells));
  std::vector<std::vector<WallSegment>> in_cell(std::size_t{cells_} * cells_);
  const auto put = [&](const WallSegment& wall) {
    const std::array<PlanePoint, 2> ends{wall.from, wall.to};
    const Range range = cells_of(ends);
    const double rise = wall.to.b2 - wall.from.b2;
    for (std::uint32_t row = range.first_row; row <= range.last_row; ++row) {
      // The part of the wall that may lie in this row; the outer rows have what lies beyond them, too.
      const auto share = [&](double b2) { return std::clamp((b2 - wall.from.b2) / rise, 0.0, 1.0); };
      double from = 0;
      double to = 1;
      if (range.first_row < range.last_row) {
        const double low = row == 0 ? -HUGE_VAL : static_cast<double>(row) / cells_ - kRounding;
        const double high = row + 1 == cells_ ? HUGE_VAL : (row + 1.0) / cells_ + kRounding;
        from = share(rise > 0 ? low : high);
        to = share(rise > 0 ? high : low);
      }
      const auto at = [&](double t) {
        return PlanePoint{wall.from.b1 + (wall.to.b1 - wall.from.b1) * t, wall.from.b2 + rise * t};
      };
      const std::array<PlanePoint, 2> part{at(from), at(to)};
      const Range columns = cells_of(part);
      for (std::uint32_t column = columns.first_column; column <= columns.last_column; ++column)
        in_cell[std::size_t{row} * cells_ + column].push_back(wall);
    }
  };
  for (const auto& side : walls) std::ranges::for_each(side, put);
  begin_.push_back(0);
  for (const auto& cell : in_cell) {
    walls_.insert(walls_.end(), cell.begin(), cell.end());
    begin_.push_back(static_cast<std::uint32_t>(walls_.size()));
  }
}

}  // namespace torolux
