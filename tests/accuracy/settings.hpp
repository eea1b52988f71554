// SPDX-License-Identifier: MIT
// The settings at which a scene's error is measured: the quality presets, and steps between and beyond them.
#pragma once

#include <array>

#include "host_tools/scene/scene.hpp"
#include "host_tools/settings/presets.hpp"

namespace torolux::accuracy {

using Setting = Preset;

inline constexpr std::array<Setting, 6> kSettings = {{
    {"coarse",
     "",
     {.samples = 2,
      .patch_factor = 4,
      .element_factor = 4,
      .hemicube = 6,
      .shot_points = 2,
      .emission_records = 100'000,
      .unshot = 0.1},
     {2, 25'000, 48}},
    kPresets[0],
    {"rough",
     "",
     {.samples = 8,
      .patch_factor = 1.4,
      .element_factor = 1.4,
      .shot_points = 9,
      .emission_records = 1'500'000,
      .unshot = 0.006},
     {5, 375'000, 240}},
    kPresets[1],
    {"good",
     "",
     {.samples = 64, .patch_factor = 0.7, .refine = 0.25, .emission_records = 8'000'000, .unshot = 0.001},
     {16, 8'000'000, 0}},
    kPresets[2],
}};

/// As the command line has it when the setting is its --quality.
Quality quality_at(const Setting& setting, const Scene& scene);

}  // namespace torolux::accuracy
