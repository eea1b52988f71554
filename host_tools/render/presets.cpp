// SPDX-License-Identifier: MIT
// See presets.hpp.
#include "host_tools/render/presets.hpp"

#include <algorithm>

namespace torolux {

std::optional<Preset> preset_named(std::string_view name) {
  const auto found = std::ranges::find(kPresets, name, &Preset::name);
  return found == kPresets.end() ? std::nullopt : std::optional(*found);
}

void apply(const Preset& preset, Quality& quality) {
  quality.lengths = preset.lengths;
  quality.hemicube = preset.hemicube;
  quality.shot_points = preset.shot_points;
  quality.emission_records = preset.emission_records;
  quality.unshot = preset.unshot;
  quality.refine = preset.refine;
  quality.shadow_rays = preset.shadow_rays;
  quality.samples = preset.samples;
}

}  // namespace torolux
