// SPDX-License-Identifier: MIT
// Quality presets: settings that belong together. Measured errors and costs: docs/quality.md.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "host_tools/settings/quality.hpp"

namespace torolux {

/// Where elements look for light themselves, shots send fewer records.
struct FinalGathering {
  std::uint32_t shot_points, emission_records,
      final_gather;  ///< as Quality; 0 rays: so many records that they win nothing
};

struct Preset {
  std::string_view name;
  std::string_view what;
  Quality quality;  ///< of it the options that are in_presets; factors multiply what the scene says or is chosen for it
  FinalGathering gathering;  ///< in their place in `quality`, where hardly any surface turns light
};

/// `normal` is what Quality has built in.
inline constexpr std::array<Preset, 3> kPresets{{
    {"draft",
     "a few seconds: to see what is there",
     {.samples = 4,
      .patch_factor = 2,
      .element_factor = 2,
      .shot_points = 6,
      .emission_records = 500'000,
      .unshot = 0.02},
     {4, 125'000, 96}},
    {"normal", "the default", {}, {8, 1'000'000, 512}},
    {"fine",
     "minutes: little noise, light followed into corners",
     {.samples = 128,
      .patch_factor = 0.5,
      .element_factor = 0.8,
      .refine = 1,
      .hemicube = 6,
      .shot_points = 20,
      .emission_records = 16'000'000,
      .unshot = 0.0005},
     {20, 16'000'000, 0}},
}};

/// Absent: there is none of this name.
std::optional<Preset> preset_named(std::string_view name);

Preset with_final_gathering(Preset preset);

/// Sets all that a preset decides.
void apply(const Preset& preset, Quality& quality);

/// From `was`, at which a scene has settings of its own, to `is`: numbers change in the same measure; refinement
/// stays that goes beyond `is` (but not to a coarser preset).
void change_preset(const Preset& was, const Preset& is, Quality& quality);

}  // namespace torolux
