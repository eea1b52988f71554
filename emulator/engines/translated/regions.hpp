// SPDX-License-Identifier: MIT
// Regions: functions of the image that become one function of the host. Inside it guest registers are local variables;
// on the way between regions they go through memory.
#pragma once

#include <cstdint>
#include <vector>

#include "emulator/engines/translated/blocks.hpp"

namespace torolux::translated {

/// Addresses of blocks, ascending.
using Region = std::vector<std::uint32_t>;

/// Every block belongs to one region. Makes entries of blocks that are reached from another region.
std::vector<Region> make_regions(Blocks& blocks);

}  // namespace torolux::translated
