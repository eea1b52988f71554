// SPDX-License-Identifier: MIT
// A name enters and its preset leaves; or settings enter and leave changed: set to a preset, or, where they were chosen
// at one preset, in the same measure at another.
#include "host_tools/settings/presets.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/protocol/stores.hpp"

namespace torolux {
namespace {

/// `value` was chosen where the preset has `was`; a whole number from 1 to `most`.
std::uint32_t in_measure(std::uint32_t value, std::uint32_t was, std::uint32_t is, double most) {
  return static_cast<std::uint32_t>(std::lround(std::clamp(static_cast<double>(value) * is / was, 1.0, most)));
}

double in_measure(double value, double was, double is) {
  if (was == is) return value;  // to the last bit
  return value == was ? is : value * is / was;
}

}  // namespace

std::optional<Preset> preset_named(std::string_view name) {
  const auto found = std::ranges::find(kPresets, name, &Preset::name);
  return found == kPresets.end() ? std::nullopt : std::optional(*found);
}

void apply(const Preset& preset, Quality& quality) {
  quality.patch_factor = preset.patch_factor;
  quality.element_factor = preset.element_factor;
  quality.hemicube = preset.hemicube;
  quality.shot_points = preset.shot_points;
  quality.emission_records = preset.emission_records;
  quality.unshot = preset.unshot;
  quality.refine = preset.refine;
  quality.samples = preset.samples;
}

void change_preset(const Preset& was, const Preset& is, Quality& quality) {
  quality.patch_factor = is.patch_factor;
  quality.element_factor = is.element_factor;
  const std::uint32_t pixels = in_measure(quality.hemicube, was.hemicube, is.hemicube, protocol::kMostHemicubeSize - 1);
  quality.hemicube = std::max(4U, (pixels + 1) / 2 * 2);
  quality.shot_points = in_measure(quality.shot_points, was.shot_points, is.shot_points, protocol::kMostShotPoints);
  quality.emission_records =
      in_measure(quality.emission_records, was.emission_records, is.emission_records, kMostEmissionRecords);
  quality.unshot = std::min(in_measure(quality.unshot, was.unshot, is.unshot), 1.0);
  const bool refined = quality.refine > was.refine && is.patch_factor <= was.patch_factor;
  quality.refine = refined ? std::max(quality.refine, is.refine) : is.refine;
  quality.samples = in_measure(quality.samples, was.samples, is.samples, kMostSamples);
}

}  // namespace torolux
