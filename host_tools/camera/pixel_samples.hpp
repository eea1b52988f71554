// SPDX-License-Identifier: MIT
// Where the samples of a pixel lie on the picture: drawn from the reconstruction filter around its middle, so that each
// weighs the same and falls on no other pixel (filter importance sampling: Ernst, Stamminger & Greiner 2006).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "firmware/protocol/camera_ray.hpp"
#include "host_tools/settings/quality.hpp"

namespace torolux {

/// A place in a pixel, from its upper left corner, in pixels, x rightwards, y downwards.
struct PixelPlace {
  double x, y;
};

/// Of the pixel's square, each 0..1. Stratified in two ways: one sample in each cell of a grid of as equal sides as
/// divide their number, and one in each of `samples` rows and columns; jittered within (one sample: the pixel's
/// centre). key: of the sample.
PixelPlace pixel_place(std::uint32_t sample, std::uint32_t samples, std::uint32_t key);

/// Distance from the middle, in pixels, below which the part `u` (0..1) of the filter lies. Rises with u.
double filter_distance(PixelFilter filter, double u);

/// What firmware/protocol/camera_ray.hpp needs to place the samples of all pixels: the pattern that all have, and the
/// filter as a table.
class PixelSamples {
 public:
  PixelSamples(PixelFilter filter, std::uint32_t samples, std::uint32_t seed);
  /// Adaptive: of the samples of a pixel every first 2^n are spread evenly.
  PixelSamples(const Quality& quality, std::uint32_t seed);

  /// Of the filter's table.
  static std::uint32_t entries(PixelFilter filter, std::uint32_t samples);

  std::uint32_t count() const { return static_cast<std::uint32_t>(places_.size()); }
  std::span<const protocol::SamplePlace> places() const { return places_; }  ///< by sample
  std::uint32_t filter_bits() const { return filter_bits_; }
  /// filter_distance at 2^filter_bits equal steps of u from 0 to 1. Nothing but zeros where there is one sample: it
  /// stands in the pixel's middle.
  std::span<const float> distances() const { return distances_; }

 private:
  std::vector<protocol::SamplePlace> places_;
  std::uint32_t filter_bits_;
  std::vector<float> distances_;
};

}  // namespace torolux
