// SPDX-License-Identifier: MIT
// A picture enters; a smaller one to look at, tone-mapped as the whole one would be, leaves.
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/picture/picture.hpp"

namespace torolux {

struct ReducedPicture {
  std::uint32_t width = 0, height = 0;
  std::vector<std::uint8_t> bytes;  ///< R G B, sRGB, row 0 on top
};

/// Means of blocks of k x k pixels of what a display would show (those at the right and lower edge may be smaller), k
/// the least with which no edge is longer than most_edge (> 0). k = 1: the bytes of tone_map.
ReducedPicture reduce(const Picture& picture, const ToneMapping& mapping, std::uint32_t most_edge);

}  // namespace torolux
