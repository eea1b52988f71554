// SPDX-License-Identifier: MIT
// Cells: what subspaces are called on all PEs alike, and each PE's map of them: which hold anything, and who has those.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/protocol/machine.hpp"

namespace torolux::protocol {

/// A cell's code: x, y, z, counted from 0, in 10 bits each.
using CellCode = std::uint32_t;
inline constexpr std::uint32_t kCellBits = 10;
inline constexpr std::uint32_t kCellMask = (1U << kCellBits) - 1U;
inline constexpr std::uint32_t kMostCellsPerAxis = 1U << kCellBits;

constexpr CellCode cell_code(std::uint32_t x, std::uint32_t y, std::uint32_t z) {
  return x | (y << kCellBits) | (z << (2U * kCellBits));
}
constexpr CellCode cell_code(const std::array<std::uint32_t, 3>& cell) {
  return cell_code(cell[0], cell[1], cell[2]);
}
constexpr std::uint32_t cell_along(CellCode code, std::uint32_t axis) {
  return (code >> (axis * kCellBits)) & kCellMask;
}

/// 32 cells of the map, in the order of their index x + Gx * (y + Gy * z), lowest bit first.
struct CellWord {
  std::uint32_t stops;   ///< a bit for each cell: a ray that comes there must stop, and the cell has an entry
  std::uint32_t before;  ///< entries of all words before this one
};
static_assert(sizeof(CellWord) == 8);
constexpr std::uint32_t cell_words(std::uint32_t cells) {
  return (cells + 31U) / 32U;
}

/// Bits that are set. Written out, as the PEs have no instruction for it and a call costs as much again.
constexpr std::uint32_t count_bits(std::uint32_t x) {
  x -= (x >> 1U) & 0x5555'5555U;
  x = (x & 0x3333'3333U) + ((x >> 2U) & 0x3333'3333U);
  x = (x + (x >> 4U)) & 0x0F0F'0F0FU;
  return (x * 0x0101'0101U) >> 24U;
}
static_assert(count_bits(0) == 0 && count_bits(0xFFFF'FFFFU) == 32 && count_bits(0x8000'0101U) == 3);

/// Number of the entry of a cell at which a ray stops. word: index / 32.
constexpr std::uint32_t entry_number(const CellWord& word, std::uint32_t index) {
  return word.before + count_bits(word.stops & ((1U << (index & 31U)) - 1U));
}

/// An entry of the map: the number of the subspace on this PE, or the PE to which records are handed.
using CellEntry = std::uint32_t;
inline constexpr CellEntry kHeld = 0x8000'0000U;
constexpr CellEntry held_as(std::uint32_t subspace) {
  return kHeld | subspace;
}

}  // namespace torolux::protocol
