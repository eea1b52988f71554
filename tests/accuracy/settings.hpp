// SPDX-License-Identifier: MIT
// The settings at which a scene's error is measured: factors to what `torolux render` would take for it.
#pragma once

#include <array>

#include "host_tools/render/render.hpp"

namespace torolux::accuracy {

struct Setting {
  const char* name;
  double length;  ///< of patches and elements
  std::uint32_t hemicube_percent;
  std::uint32_t shot_points;  ///< 0: as settled
  double unshot;
  std::uint32_t samples_percent;
};

inline constexpr std::array<Setting, 4> kSettings = {{
    {"coarse", 2, 50, 1, 3, 100},
    {"default", 1, 100, 0, 1, 100},
    {"fine", 0.5, 100, 0, 0.3, 400},
    {"finer", 0.5, 100, 4, 0.1, 400},
}};

/// `settled`: as for the command line; lengths that are chosen by themselves are looked up first.
Quality quality_at(const Setting& setting, const Quality& settled, const Scene& scene);

}  // namespace torolux::accuracy
