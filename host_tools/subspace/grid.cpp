// SPDX-License-Identifier: MIT
// The number of cells, if not given, follows from the number of triangles, and of PEs or their memory. Polygons are
// listed by a test of triangle against box, with a margin.
#include "host_tools/subspace/grid.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "emulator/errors.hpp"
#include "host_tools/subspace/overlap.hpp"

namespace torolux {
namespace {

/// Along the longest axis, times the cube root of the number of triangles. One PE is fastest with 24 to 32
/// for 12,000, and with 3 for the 34 of the Cornell box.
constexpr double kSpreadCells = 1.0;
constexpr double kLeastSpreadCells = 2;
constexpr double kMostSpreadCells = 64;
/// Of the map, for each cell: a bit and its share of a word's rank, and an entry for about one cell in eight.
constexpr double kMapBytes = 0.75;
/// Of a PE's memory, for the map.
constexpr double kMostMap = 1.0 / 32;

std::array<std::uint32_t, 3> cells_along(const SceneSpace& space, std::uint32_t longest) {
  std::array<std::uint32_t, 3> cells{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cells[axis] = std::max(1U, static_cast<std::uint32_t>(std::lround(longest * space.size[axis])));
  }
  return cells;
}

std::array<std::uint32_t, 3> automatic_cells(const SceneSpace& space, std::size_t triangles, std::size_t pes) {
  const double wanted = std::clamp(std::round(0.8 * std::cbrt(static_cast<double>(triangles))), 8.0, 32.0);
  auto longest = static_cast<std::uint32_t>(wanted);
  for (;; ++longest) {
    const std::array<std::uint32_t, 3> cells = cells_along(space, longest);
    if (std::size_t{cells[0]} * cells[1] * cells[2] >= 4 * pes || longest >= 64) return cells;
  }
}

void check(const std::array<std::uint32_t, 3>& cells) {
  std::uint64_t count = 1;
  for (const std::uint32_t n : cells) {
    if (n == 0 || n > kMostCellsPerAxis) {
      throw UsageError("--subspaces: " + std::to_string(n) + " along an axis; 1 to " +
                       std::to_string(kMostCellsPerAxis) + " are allowed");
    }
    count *= n;
  }
  if (count > kMostCells) {
    throw UsageError("--subspaces: " + std::to_string(count) + " in all; at most " + std::to_string(kMostCells) +
                     " are allowed");
  }
}

}  // namespace

std::array<std::uint32_t, 3> Grid::cell_of(const protocol::Vec3f& point) const {
  std::array<std::uint32_t, 3> cell{};
  for (std::size_t axis = 0; axis < 3; ++axis) cell[axis] = protocol::cell_on_axis(shape(), axis, point[axis]);
  return cell;
}

Grid make_grid(const SceneSpace& space, std::optional<std::array<std::uint32_t, 3>> cells, std::size_t triangles,
               std::size_t pes) {
  Grid grid;
  grid.cells = cells ? *cells : automatic_cells(space, triangles, pes);
  check(grid.cells);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    grid.cell_size[axis] = static_cast<float>(space.size[axis] / grid.cells[axis]);
  }
  return grid;
}

std::array<std::uint32_t, 3> spread_cells(const SceneSpace& space, std::size_t triangles, std::uint32_t memory) {
  const double wanted = std::round(kSpreadCells * std::cbrt(static_cast<double>(triangles)));
  auto longest = static_cast<std::uint32_t>(std::clamp(wanted, kLeastSpreadCells, kMostSpreadCells));
  for (;; --longest) {
    const std::array<std::uint32_t, 3> cells = cells_along(space, longest);
    const double map = kMapBytes * cells[0] * cells[1] * cells[2];
    if (map <= kMostMap * memory || longest <= kLeastSpreadCells) return cells;
  }
}

std::vector<std::vector<std::uint32_t>> polygons_by_cell(const Grid& grid, std::span<const MeshTriangle> triangles) {
  std::vector<std::vector<std::uint32_t>> lists(grid.count());
  constexpr double margin = protocol::kSubspaceMargin;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    const std::array<Vec3d, 3> corner{to_double(triangles[t].corner[0]), to_double(triangles[t].corner[1]),
                                      to_double(triangles[t].corner[2])};
    std::array<std::array<std::uint32_t, 2>, 3> range{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto [low, high] = std::minmax({corner[0][axis], corner[1][axis], corner[2][axis]});
      // One cell more on each side than the box needs: overlap decides.
      const double size = static_cast<double>(grid.cell_size[axis]);
      const auto cell_at = [&](double at) {
        return static_cast<std::uint32_t>(std::clamp(std::floor(at / size), 0.0, grid.cells[axis] - 1.0));
      };
      range[axis] = {cell_at(low - 2 * margin), cell_at(high + 2 * margin)};
    }
    for (std::uint32_t z = range[2][0]; z <= range[2][1]; ++z) {
      for (std::uint32_t y = range[1][0]; y <= range[1][1]; ++y) {
        for (std::uint32_t x = range[0][0]; x <= range[0][1]; ++x) {
          const Vec3d low{static_cast<double>(grid.plane(0, x)), static_cast<double>(grid.plane(1, y)),
                          static_cast<double>(grid.plane(2, z))};
          const Vec3d high{static_cast<double>(grid.plane(0, x + 1)), static_cast<double>(grid.plane(1, y + 1)),
                           static_cast<double>(grid.plane(2, z + 1))};
          if (touches_box(corner, low, high, margin)) lists[grid.index({x, y, z})].push_back(t);
        }
      }
    }
  }
  return lists;
}

}  // namespace torolux
