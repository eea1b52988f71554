// SPDX-License-Identifier: MIT
// The settings of the picture. What stands in them enters a render; nothing else of the settings shows in its picture.
#pragma once

#include <cstdint>
#include <optional>

#include "host_tools/picture/layers.hpp"
#include "host_tools/settings/pixel_filter.hpp"

namespace torolux {

inline constexpr std::uint32_t kMostSamples = 65536;  ///< of a pixel
inline constexpr std::uint32_t kMostEmissionRecords = 1'000'000'000;
inline constexpr std::uint32_t kMostGatherRays = 65536;  ///< of an element, in the mean
/// 16 MiB of a PE's memory.
inline constexpr std::uint32_t kMostTexels = 4U << 20U;

/// Everything that determines the picture, and nothing that does not.
struct Quality {
  std::uint32_t width = 512, height = 512;
  std::uint32_t samples = 32;      ///< per pixel
  std::uint32_t most_samples = 0;  ///< not 0: pixels have from `samples` to so many, as they need them
  double noise = 2;                ///< then: halves of a block's samples that differ by more [L*] ask for more
  PixelFilter filter = PixelFilter::box;
  LayerSet layers = 0;                                ///< of the picture, besides its colours, which they do not change
  std::optional<double> patch_length = std::nullopt;  ///< longest edge, scene units; absent: auto
  std::optional<double> element_length = std::nullopt;
  double patch_factor = 1, element_factor = 1;  ///< of lengths that are chosen by themselves
  /// Of elements of several small triangles each, which are not refined, times the length of the others.
  double cluster_factor = 1;
  /// Elements that are added where a draft of the solution says so, as a multiple of those without; 0: no draft.
  double refine = 0;
  std::uint32_t hemicube = 4;      ///< pixels across the top, even, 4..256
  std::uint32_t shot_points = 16;  ///< k: k * k points per patch
  /// With which all emitters together begin, about: their light casts the sharpest shadows, so that a patch that emits
  /// gets more points than one that only reflects.
  std::uint32_t emission_records = 4'000'000;
  /// Not 0: elements gather what lights them when all shots are over, by so many rays in the mean.
  std::uint32_t final_gather = 0;
  double unshot = 0.002;        ///< fraction of the emitted flux at which the radiosity stage ends
  std::uint32_t max_shots = 0;  ///< patches shot in all; 0: no limit
  std::uint32_t bounces = 32;   ///< path segments
  /// Light straight from emitters comes by a shadow ray from each diffuse point that is seen, not from the elements.
  bool shadow_rays = true;
  bool two_sided_lights = false;
  std::uint32_t texels = 16384;  ///< of each texture, at most; 1..kMostTexels
  std::uint64_t seed = 1;

  bool adaptive() const { return most_samples != 0; }
  /// That a pixel may have.
  std::uint32_t sample_places() const { return adaptive() ? most_samples : samples; }
};

}  // namespace torolux
