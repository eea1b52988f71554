// SPDX-License-Identifier: MIT
// A PE's map of the cells: where a ray must stop, and who has what is there. And which cell holds a point.
#pragma once

#include <cstdint>
#include <span>

#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/first_cell.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

struct CellMap {
  std::span<const protocol::CellWord> words;
  std::span<const protocol::CellEntry> entries;

  bool stops(std::uint32_t index) const { return ((words[index >> 5U].stops >> (index & 31U)) & 1U) != 0; }
  /// Of a cell at which a ray stops.
  protocol::CellEntry entry(std::uint32_t index) const { return entries[entry_number(words[index >> 5U], index)]; }
};

inline std::uint32_t cell_index(const protocol::StageLayout& layout, protocol::CellCode code) {
  return protocol::cell_along(code, 0) +
         layout.cells[0] * (protocol::cell_along(code, 1) + layout.cells[1] * protocol::cell_along(code, 2));
}

inline protocol::GridShape grid_of(const protocol::StageLayout& layout) {
  return {layout.cells, layout.cell_size};
}

/// The cell between whose planes a point lies, the lower one included. Points outside the object space belong to the
/// nearest cell.
inline protocol::CellCode cell_of(const protocol::StageLayout& layout, const glm::vec3& point) {
  const protocol::GridShape grid = grid_of(layout);
  return protocol::cell_code(protocol::cell_on_axis(grid, 0, point.x), protocol::cell_on_axis(grid, 1, point.y),
                             protocol::cell_on_axis(grid, 2, point.z));
}

}  // namespace torolux::pe
