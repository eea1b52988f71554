// SPDX-License-Identifier: MIT
// The settings at which a scene's error is measured: the quality presets, and steps between and beyond them.
#pragma once

#include <array>

#include "host_tools/scene/scene.hpp"
#include "host_tools/settings/presets.hpp"

namespace torolux::accuracy {

using Setting = Preset;

inline constexpr std::array<Setting, 6> kSettings = {{
    {"coarse", "", 4, 4, 6, 2, 100'000, 0.1, 0, 2},
    kPresets[0],
    {"rough", "", 1.4, 1.4, 8, 4, 1'500'000, 0.006, 0, 8},
    kPresets[1],
    {"good", "", 0.7, 1, 8, 6, 8'000'000, 0.001, 0.25, 32},
    kPresets[2],
}};

/// As the command line has it when the setting is its --quality.
Quality quality_at(const Setting& setting, const Scene& scene);

}  // namespace torolux::accuracy
