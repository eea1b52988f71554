// SPDX-License-Identifier: MIT
// Triangles and lengths enter; how many patches and elements they ask for leaves, counted before any is made. What no
// machine holds is refused.
#pragma once

#include <cstdint>
#include <span>

#include "host_tools/mesh/levels.hpp"

namespace torolux {

/// A triangle with sides.
struct SizedTriangle {
  double longest_edge = 0;  ///< [user units]
  std::uint32_t sides = 0;  ///< 1 or 2
};

/// Counts of all PEs together.
struct MeshSize {
  std::uint64_t patches = 0, patch_sides = 0, elements = 0;  ///< elements of all sides

  /// That they take of the PEs' memory in the radiosity stage, at least.
  std::uint64_t bytes() const;
};

/// At least: of triangles that lengths cut. Those that stay whole may join others, and walls and splits cut more.
MeshSize least_size(std::span<const SizedTriangle> triangles, const MeshLengths& lengths);

/// So many are made within seconds, so that whether they fit can be told exactly.
inline constexpr std::uint64_t kSoonMade = std::uint64_t{1} << 20U;

/// Throws InputError, with lengths that are not refused: more than kMostElements or kMostPatchSides, or
/// than kSoonMade and than machine_bytes hold [bytes, of all PEs together].
void require_possible(std::span<const SizedTriangle> triangles, const MeshLengths& lengths,
                      std::uint64_t machine_bytes);

}  // namespace torolux
