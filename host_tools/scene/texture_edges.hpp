// SPDX-License-Identifier: MIT
// A triangle whose texture points lie beyond a texture that does not repeat enters; its parts within and beyond each
// edge, and the texture points that they show, leave.
#pragma once

#include <array>
#include <vector>

#include "host_tools/scene/cut_out.hpp"

namespace torolux {

using TexturePoint2 = std::array<double, 2>;

/// Parts of which each lies within 0 to 1 or beyond it, in u and in v; they keep the triangle's winding.
std::vector<CutOutPart> parts_at_edges(const std::array<TexturePoint2, 3>& points);

/// Texture points of one of these parts: those beyond an edge show what is at it.
void clamp_to_edges(std::array<TexturePoint2, 3>& points);

}  // namespace torolux
