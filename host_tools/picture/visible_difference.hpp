// SPDX-License-Identifier: MIT
// Two pictures of radiance enter; what a person would see of their difference leaves.
#pragma once

#include <filesystem>

#include "host_tools/picture/flip.hpp"
#include "host_tools/picture/streaks.hpp"

namespace torolux {

/// Of both pictures as a .png of render would show the reference: with the reference's exposure of 0 EV and the filmic
/// curve (tone_map.hpp), but not rounded to 8 bits.
struct VisibleDifference {
  Plane flip_map;  ///< flip.hpp, 0..1
  Pooled flip;
  Pooled hdr_flip;  ///< with the exposures of hdr_flip instead
  Streaks streaks;
};

/// pixels_per_degree > 0. Same size, not empty, finite.
VisibleDifference visible_difference(const Picture& picture, const Picture& reference, double pixels_per_degree);

/// By extension, as write_picture: .exr and .pfm have the values, equal in all channels; .png grey of 255 times them,
/// without a tone curve. Throws InputError where it cannot be written.
void write_flip_map(const Plane& flip_map, const std::filesystem::path& file);

}  // namespace torolux
