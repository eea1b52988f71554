// SPDX-License-Identifier: MIT
// Boxes in 16 x 16 x 16 parts of a subspace, packed into a word, so that a ray passes over a polygon beside it by one
// subtraction. Enters: a polygon's corners and a cell; leaves: its entry in the cell's list.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/protocol/records.hpp"

namespace torolux::protocol {

/// How far beyond a subspace's box a polygon still stands in it, so that rounding never hides a hit.
inline constexpr float kSubspaceMargin = 0x1p-13F;

/// Parts of a subspace's edge.
inline constexpr std::uint32_t kBoxParts = 16;

/// Six numbers 0..15, each with an empty bit above it, in which a subtraction of such words leaves a 1 where nothing
/// was borrowed (L. Lamport, "Multiple byte processing with full-word instructions", Communications of the ACM 18(8),
/// 1975). By axis a, at bit 10 a: a polygon's lowest part; a ray's highest. At bit 10 a + 5: 15 - a polygon's highest
/// part; 15 - a ray's lowest.
using PackedBox = std::uint32_t;
inline constexpr std::uint32_t kBoxAxisShift = 10;
inline constexpr std::uint32_t kBoxUpperShift = 5;
inline constexpr std::uint32_t kBoxGuards = 0x2108'4210U;
/// The ray's word, which has a 1 above each number, from one with a lowest part in place of 15 - that.
inline constexpr std::uint32_t kBoxRayFlips = 0x3F0F'C3F0U;
constexpr bool boxes_apart(std::uint32_t ray, PackedBox polygon) {
  return ((ray - polygon) & kBoxGuards) != kBoxGuards;
}

constexpr std::uint32_t lowest_part(PackedBox polygon, std::uint32_t axis) {
  return polygon >> (kBoxAxisShift * axis) & (kBoxParts - 1U);
}
constexpr std::uint32_t highest_part(PackedBox polygon, std::uint32_t axis) {
  return kBoxParts - 1U - (polygon >> (kBoxAxisShift * axis + kBoxUpperShift) & (kBoxParts - 1U));
}
/// The box around two: of every number the smaller one.
constexpr PackedBox box_around(PackedBox a, PackedBox b) {
  PackedBox both = 0;
  for (std::uint32_t shift = 0; shift < 3U * kBoxAxisShift; shift += kBoxUpperShift) {
    const std::uint32_t of_a = a >> shift & (kBoxParts - 1U);
    const std::uint32_t of_b = b >> shift & (kBoxParts - 1U);
    both |= (of_a < of_b ? of_a : of_b) << shift;
  }
  return both;
}

/// A polygon as one subspace knows it, or a group of them: a ray beside its box passes over all. A subspace's polygons
/// are all in groups, or none.
struct ListedPolygon {
  PackedBox box;
  std::uint32_t polygon;  ///< index into polygons; or kGroup | how many entries behind this one are the group's
};
inline constexpr std::uint32_t kGroup = 0x8000'0000U;
static_assert(sizeof(ListedPolygon) == 8);

/// corner: of a polygon that stands in the cell; its box is grown by kSubspaceMargin, of which a PE's rounding needs a
/// hundredth.
constexpr PackedBox box_in_cell(const std::array<Vec3f, 3>& corner, const Vec3f& cell_size,
                                const std::array<std::uint32_t, 3>& cell) {
  PackedBox box = 0;
  for (std::uint32_t a = 0; a < 3; ++a) {
    const auto part_of = [&](double x) {
      const double parts = (x / static_cast<double>(cell_size[a]) - static_cast<double>(cell[a])) * kBoxParts;
      const double most = kBoxParts - 1;
      return static_cast<std::uint32_t>(parts < 0.0 ? 0.0 : parts > most ? most : parts);
    };
    float low = corner[0][a];
    float high = low;
    for (const Vec3f& c : corner) {
      if (c[a] < low) low = c[a];
      if (c[a] > high) high = c[a];
    }
    const std::uint32_t lowest = part_of(static_cast<double>(low) - static_cast<double>(kSubspaceMargin));
    const std::uint32_t highest = part_of(static_cast<double>(high) + static_cast<double>(kSubspaceMargin));
    box |= (lowest | (kBoxParts - 1U - highest) << kBoxUpperShift) << (kBoxAxisShift * a);
  }
  return box;
}

}  // namespace torolux::protocol
