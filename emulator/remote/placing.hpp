// SPDX-License-Identifier: MIT
// Which rank runs which PE: numbers of PEs and ranks enter, a rank for each PE leaves. No result depends on it.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace torolux::remote {

enum class Placing : std::uint8_t {
  block,   ///< neighbours together
  cyclic,  ///< one after the other
  random   ///< by a hash of the PE's number
};

/// By its name. Throws UsageError.
Placing placing_named(std::string_view name);

/// Of each PE: 1 to ranks - 1. Rank 0 has the network, and runs none. ranks: at least 2.
std::vector<unsigned> place_pes(unsigned pes, unsigned ranks, Placing placing);

}  // namespace torolux::remote
