// SPDX-License-Identifier: MIT
// A picture of radiance and what is to look white enter; the picture in which it does leaves.
#pragma once

#include <array>
#include <optional>

#include "host_tools/picture/picture.hpp"

namespace torolux {

/// The colour of the light in a picture, guessed: Shades of Grey (G. Finlayson, E. Trezzi, "Shades of gray and colour
/// constancy", 2004), the mean of the sixth powers, over the pixels by which exposure is measured (tone_map.hpp), so
/// that bright surfaces tell more than dark ones, and lamps in view nothing. Its greatest channel is 1, none is below
/// 0.05; white for a black picture.
std::array<double, 3> light_colour(const Picture& picture);

/// Absent: nothing is to be changed.
std::optional<Picture> balanced(const Picture& picture, const WhiteBalance& white);

}  // namespace torolux
