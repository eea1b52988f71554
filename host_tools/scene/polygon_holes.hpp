// SPDX-License-Identifier: MIT
// A polygon with holes enters; one polygon without leaves, joined by seams.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Corner numbers of `corners` in the order of one outline that runs along the first contour and, by seams that it
/// walks both ways, around the others. contours: numbers of corners, planar or nearly, in any winding; the first is the
/// outer one and keeps its winding.
std::vector<std::uint32_t> joined_contours(std::span<const Vec3d> corners,
                                           const std::vector<std::vector<std::uint32_t>>& contours);

}  // namespace torolux
