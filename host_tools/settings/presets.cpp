// SPDX-License-Identifier: MIT
// A name enters and its preset leaves; or settings enter and leave changed: set to a preset, or, where they were chosen
// at one preset, in the same measure at another.
#include "host_tools/settings/presets.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "host_tools/settings/options.hpp"
#include "host_tools/settings/overloaded.hpp"

namespace torolux {
namespace {

/// `value` was chosen where the preset has `was`.
double in_measure(double value, double was, double is) {
  if (was == is) return value;  // to the last bit
  return value == was || was == 0 ? is : value * is / was;
}

/// Even where it must be; at least 1.
std::uint64_t in_measure(std::uint64_t value, std::uint64_t was, std::uint64_t is, const auto& count) {
  if (was == is) return value;
  if (was == 0) return value == 0 ? is : value;
  if (is == 0) return is;
  const double most = static_cast<double>(count.even ? count.most - 1 : count.most);
  const double wanted = static_cast<double>(value) * static_cast<double>(is) / static_cast<double>(was);
  const auto whole = static_cast<std::uint64_t>(std::lround(std::clamp(wanted, 1.0, most)));
  return std::max(count.least, count.even ? (whole + 1) / 2 * 2 : whole);
}

}  // namespace

std::optional<Preset> preset_named(std::string_view name) {
  const auto found = std::ranges::find(kPresets, name, &Preset::name);
  return found == kPresets.end() ? std::nullopt : std::optional(*found);
}

Preset with_final_gathering(Preset preset) {
  preset.quality.shot_points = preset.gathering.shot_points;
  preset.quality.emission_records = preset.gathering.emission_records;
  preset.quality.final_gather = preset.gathering.final_gather;
  return preset;
}

void apply(const Preset& preset, Quality& quality) {
  const AllSettings from{preset.quality, {}, {}};
  AllSettings to{quality, {}, {}};
  for (const Option& option : all_options()) {
    if (option.in_presets) copy_value(option, from, to);
  }
  quality = to.quality;
}

void change_preset(const Preset& was, const Preset& is, Quality& quality) {
  const AllSettings before{was.quality, {}, {}};
  const AllSettings after{is.quality, {}, {}};
  AllSettings settings{quality, {}, {}};
  const Overloaded change{
      [&](const option::Number& kind) {
        const double value = in_measure(kind.member.of(settings), kind.member.of(before), kind.member.of(after));
        kind.member.in(settings) = std::clamp(value, kind.least, kind.most);
      },
      [&]<class Integer>(const option::Count<Integer>& kind) {
        kind.member.in(settings) = static_cast<Integer>(
            in_measure(kind.member.of(settings), kind.member.of(before), kind.member.of(after), kind));
      },
      [&](const auto& kind) { static_cast<void>(kind); },
  };
  for (const Option& option : all_options()) {
    if (option.in_presets) std::visit(change, option.kind);
  }
  const double refine = quality.refine;
  quality = settings.quality;
  const bool refined = refine > was.quality.refine && is.quality.patch_factor <= was.quality.patch_factor;
  quality.refine = refined ? std::max(refine, is.quality.refine) : is.quality.refine;
}

}  // namespace torolux
