// SPDX-License-Identifier: MIT
// Where a ray's walk through the grid of subspaces begins. Enters: a ray; leaves: a cell, and through which face the
// ray came in. The host and the PEs share it; distances to planes are those of firmware/pe/walk.hpp to the last bit.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <optional>

#include "firmware/protocol/records.hpp"

namespace torolux::protocol {

struct GridShape {
  std::array<std::uint32_t, 3> cells;  ///< by axis, 1 or more
  Vec3f cell_size;                     ///< > 0

  constexpr float plane(std::size_t axis, std::uint32_t index) const {
    return static_cast<float>(index) * cell_size[axis];
  }
};

/// Distances along a ray to the planes between cells.
class RayPlanes {
 public:
  constexpr RayPlanes(const GridShape& grid, const Vec3f& origin, const Vec3f& direction)
      : grid_(grid),
        origin_(origin),
        inverse_{inverse_of(direction[0]), inverse_of(direction[1]), inverse_of(direction[2])},
        upward_{is_upward(direction[0]), is_upward(direction[1]), is_upward(direction[2])} {}
  constexpr bool meets(std::size_t axis) const { return inverse_[axis] != 0; }
  constexpr bool upward(std::size_t axis) const { return upward_[axis]; }
  constexpr float distance(std::size_t axis, std::uint32_t plane) const {
    return meets(axis) ? (grid_.plane(axis, plane) - origin_[axis]) * inverse_[axis]
                       : std::numeric_limits<float>::infinity();
  }
  /// To the plane through which the ray leaves this cell; never falls from one cell to the next along the ray.
  constexpr float exit(std::size_t axis, std::uint32_t cell) const {
    return distance(axis, cell + (upward_[axis] ? 1U : 0U));
  }

 private:
  static constexpr float inverse_of(float along) {
    constexpr std::uint32_t least = std::bit_cast<std::uint32_t>(0x1p-64F);  // less: its t would end before 2
    return (std::bit_cast<std::uint32_t>(along) & 0x7FFF'FFFFU) >= least ? 1.0F / along : 0.0F;
  }
  static constexpr bool is_upward(float along) { return std::bit_cast<std::uint32_t>(along) >> 31U == 0; }

  const GridShape& grid_;
  Vec3f origin_;
  Vec3f inverse_;
  std::array<bool, 3> upward_;
};

/// The cell whose planes enclose a coordinate, the lower one included; beyond the grid, the last.
constexpr std::uint32_t cell_on_axis(const GridShape& grid, std::size_t axis, float at) {
  const float guess = at / grid.cell_size[axis];
  const std::uint32_t last = grid.cells[axis] - 1U;
  std::uint32_t cell = !(guess > 0.0F)                    ? 0U
                       : guess < static_cast<float>(last) ? static_cast<std::uint32_t>(guess)
                                                          : last;
  while (cell > 0U && grid.plane(axis, cell) > at) --cell;  // the guess is rounded otherwise than the planes
  while (cell < last && grid.plane(axis, cell + 1U) <= at) ++cell;
  return cell;
}

struct FirstCell {
  std::array<std::uint32_t, 3> cell;
  std::uint8_t flags;  ///< kFirst: the origin lies in it; else the axis of the face through which the ray enters
};

constexpr bool lies_inside(const GridShape& grid, const Vec3f& point) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!(point[axis] >= 0.0F && point[axis] < grid.plane(axis, grid.cells[axis]))) return false;
  }
  return true;
}

/// Of an origin outside: the cell behind the last of the three planes through which the ray comes in. Nothing where it
/// misses the grid.
constexpr std::optional<FirstCell> cell_of_entry(const GridShape& grid, const RayPlanes& planes, const Vec3f& origin,
                                                 const Vec3f& direction) {
  float entry = -std::numeric_limits<float>::infinity();
  float exit = std::numeric_limits<float>::infinity();
  std::size_t entry_axis = 3;
#pragma GCC unroll 3
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t end = grid.cells[axis];
    if (!planes.meets(axis)) {
      if (origin[axis] < 0.0F || origin[axis] > grid.plane(axis, end)) return std::nullopt;
      continue;
    }
    const float in = planes.distance(axis, planes.upward(axis) ? 0U : end);
    const float out = planes.distance(axis, planes.upward(axis) ? end : 0U);
    if (in >= entry) {
      entry = in;
      entry_axis = axis;
    }
    if (out < exit) exit = out;
  }
  if (entry_axis == 3 || entry > exit || exit < 0.0F) return std::nullopt;
  FirstCell first{{}, static_cast<std::uint8_t>(entry_axis << kEntryAxisShift)};
#pragma GCC unroll 3
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t last = grid.cells[axis] - 1U;
    const bool upward = planes.upward(axis);
    std::uint32_t& cell = first.cell[axis];
    if (axis == entry_axis) {
      cell = upward ? 0U : last;
      continue;
    }
    cell = cell_on_axis(grid, axis, origin[axis] + (planes.meets(axis) ? direction[axis] * entry : 0.0F));
    if (!planes.meets(axis)) continue;
    // The first along the ray that it does not leave before it enters the grid.
    const std::uint32_t begin = upward ? 0U : last;
    const std::uint32_t forward = upward ? 1U : ~0U;
    while (cell != begin && !(planes.exit(axis, cell - forward) < entry)) cell -= forward;
    while (cell != last - begin && planes.exit(axis, cell) < entry) cell += forward;
  }
  return first;
}

/// The cell of the ray's origin, or the one where it enters the grid; nothing where it misses that.
constexpr std::optional<FirstCell> first_cell(const GridShape& grid, const Vec3f& origin, const Vec3f& direction) {
  if (!lies_inside(grid, origin)) return cell_of_entry(grid, RayPlanes(grid, origin, direction), origin, direction);
  FirstCell first{{}, kFirst};
  for (std::size_t axis = 0; axis < 3; ++axis) first.cell[axis] = cell_on_axis(grid, axis, origin[axis]);
  return first;
}

}  // namespace torolux::protocol
