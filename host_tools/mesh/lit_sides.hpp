// SPDX-License-Identifier: MIT
// Which sides of each triangle light may reach. Enters: triangles in normalised space; leaves: front and back bits.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/scene/scene.hpp"

namespace torolux {

struct SideTriangle {
  std::array<std::uint32_t, 3> position;
  bool opaque;              ///< not glass
  std::uint8_t emits_from;  ///< kFrontPresent | kBackPresent
};

/// Sides as kFrontPresent | kBackPresent for each triangle. A side is left out only where no light can reach it for
/// certain: it belongs to a closed component (every edge shared by exactly two triangles, wound alike, nothing of it
/// glass, nowhere touching itself), which so parts space in two, and no emitter is on that side of it.
/// positions: normalised. sky: light comes from outside of all.
std::vector<std::uint8_t> lit_sides(std::span<const Vec3d> positions, std::span<const SideTriangle> triangles,
                                    bool sky = false);

}  // namespace torolux
