// SPDX-License-Identifier: MIT
// Object space and polygons enter; the grid of equal subspaces leaves: which cell holds a point, and which cells a
// polygon touches.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "firmware/protocol/first_cell.hpp"
#include "firmware/protocol/records.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {

using CellIndex = std::uint32_t;  ///< x + cells[0] * (y + cells[1] * z)

struct Grid {
  std::array<std::uint32_t, 3> cells{1, 1, 1};
  protocol::Vec3f cell_size{1, 1, 1};  ///< plane i of an axis lies at float(i) * cell_size

  protocol::GridShape shape() const { return {cells, cell_size}; }
  std::uint32_t count() const { return cells[0] * cells[1] * cells[2]; }
  CellIndex index(const std::array<std::uint32_t, 3>& cell) const {
    return cell[0] + cells[0] * (cell[1] + cells[1] * cell[2]);
  }
  std::array<std::uint32_t, 3> cell(CellIndex index) const {
    return {index % cells[0], index / cells[0] % cells[1], index / cells[0] / cells[1]};
  }
  /// As the PEs compute it: one float product.
  float plane(std::size_t axis, std::uint32_t i) const { return static_cast<float>(i) * cell_size[axis]; }
  /// The cell whose planes enclose the point (lower one included), clamped to the grid.
  std::array<std::uint32_t, 3> cell_of(const protocol::Vec3f& point) const;
};

/// The most cells along an axis and in all: cells are numbered in 16 bits along an axis.
using protocol::kMostCellsPerAxis;
inline constexpr std::uint32_t kMostCells = 1U << 22U;

/// cells: as given, each 1..kMostCellsPerAxis (else UsageError); absent: by the number of triangles, from 8 along the
/// longest axis to 32, finer where there would be fewer than four cells for each PE.
Grid make_grid(const SceneSpace& space, std::optional<std::array<std::uint32_t, 3>> cells, std::size_t triangles,
               std::size_t pes);

/// Scheme `spread`: by the cube root of the number of triangles, 2 to 64 along the longest axis, coarser where the map
/// of the cells would take too much of a PE's memory [bytes].
std::array<std::uint32_t, 3> spread_cells(const SceneSpace& space, std::size_t triangles, std::uint32_t memory);

/// For each cell, ascending numbers of the polygons that stand in it: those that touch its box grown by
/// protocol::kSubspaceMargin on all sides.
std::vector<std::vector<std::uint32_t>> polygons_by_cell(const Grid& grid, std::span<const MeshTriangle> triangles);

}  // namespace torolux
