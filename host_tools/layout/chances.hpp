// SPDX-License-Identifier: MIT
// Weights enter; chances in whole 2^-32 leave, by which 32 random bits choose.
#pragma once

#include <cstdint>
#include <vector>

namespace torolux {

/// Upper ends of chances in units of 2^-32, less one; what has none has its neighbour's. None below 0, one above.
std::vector<std::uint32_t> chances(const std::vector<double>& weights);

}  // namespace torolux
