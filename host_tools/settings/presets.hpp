// SPDX-License-Identifier: MIT
// Quality presets: settings that belong together. Measured errors and costs: docs/quality.md.
#pragma once

#include <array>
#include <optional>
#include <string_view>

#include "host_tools/settings/quality.hpp"

namespace torolux {

struct Preset {
  std::string_view name;
  std::string_view what;
  double patch_factor, element_factor;  ///< of their lengths, times what the scene says or what is chosen for it
  std::uint32_t hemicube, shot_points, emission_records;
  double unshot;
  double refine;
  std::uint32_t samples;
};

/// `normal` is what Quality has built in.
inline constexpr std::array<Preset, 3> kPresets{{
    {"draft", "a few seconds: to see what is there", 2, 2, 8, 3, 500'000, 0.02, 0, 4},
    {"normal", "the default", 1, 1, 8, 6, 4'000'000, 0.002, 0, 16},
    {"fine", "minutes: little noise, light followed into corners", 0.5, 2, 8, 16, 24'000'000, 0.0005, 4, 64},
}};

/// Absent: there is none of this name.
std::optional<Preset> preset_named(std::string_view name);

/// Sets all that a preset decides.
void apply(const Preset& preset, Quality& quality);

/// From `was`, at which a scene has settings of its own, to `is`: numbers change in the same measure; refinement
/// stays that goes beyond `is` (but not to a coarser preset).
void change_preset(const Preset& was, const Preset& is, Quality& quality);

}  // namespace torolux
