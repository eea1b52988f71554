// SPDX-License-Identifier: MIT
// What is done where a material, its library or its texture is nowhere.
#pragma once

#include <cstdint>

namespace torolux {

enum class MissingMaterials : std::uint8_t { refuse, white };

}  // namespace torolux
