// SPDX-License-Identifier: MIT
// Writes translated code: a region's blocks in, the C++ text of one function out.
#pragma once

#include <cstddef>
#include <string>

#include "emulator/engines/translated/blocks.hpp"
#include "emulator/engines/translated/regions.hpp"

namespace torolux::translated {

/// Raised whenever the text for the same image changes: part of the cache's key.
inline constexpr unsigned kGeneratorVersion = 1;

/// Name of a region's function in the shared object.
std::string region_name(std::size_t number);

/// One translation unit with one function, RegionFunction region_name(number).
std::string generate_region(const CodeMap& code, const Blocks& blocks, const Region& region, std::size_t number);

}  // namespace torolux::translated
