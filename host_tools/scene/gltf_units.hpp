// SPDX-License-Identifier: MIT
// What a glTF file's numbers of light mean here.
#pragma once

#include <cstdint>

namespace torolux {

/// watt: cd/m^2 are taken as W/(m^2 sr), and cd as W/sr. lumen: divided by 683 lm/W.
enum class GltfUnits : std::uint8_t { watt, lumen };

/// Radiance here for luminance there.
constexpr double radiance_per_luminance(GltfUnits units) {
  constexpr double efficacy = 683;  // lm/W, of the SI's candela
  return units == GltfUnits::lumen ? 1 / efficacy : 1;
}

}  // namespace torolux
