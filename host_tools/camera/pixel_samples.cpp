// SPDX-License-Identifier: MIT
// Correlated multi-jittered places in the unit square (Kensler 2013), and a table of the filter's inverse distribution,
// by which each coordinate becomes a distance from the middle [pixels].
#include "host_tools/camera/pixel_samples.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

#include "firmware/protocol/random.hpp"
#include "firmware/protocol/stratified.hpp"

namespace torolux {
namespace {

using protocol::Dimension;

/// Steps of the table from which distances are read, as a power of two. Every PE has it: 4 KiB. Straight lines between
/// are off by up to 0.01 pixels in the first and the last step, and by less than 2e-4 pixels ten steps from there.
constexpr std::uint32_t kStepBits = 10;
constexpr std::uint32_t kStepBitsOfBox = 1;  ///< a straight line
constexpr double kGaussianReach = 1.5;       ///< [pixels]
constexpr double kGaussianWidth = 0.5;       ///< standard deviation [pixels]

/// Part of the cut-off Gaussian below a distance.
double gaussian_part(double distance) {
  const double scale = 1 / (kGaussianWidth * std::numbers::sqrt2);
  return (std::erf(distance * scale) / std::erf(kGaussianReach * scale) + 1) / 2;
}

double gaussian_distance(double u) {
  double low = -kGaussianReach;
  double high = kGaussianReach;
  while (high - low > 1e-12) {
    const double middle = (low + high) / 2;
    (gaussian_part(middle) < u ? low : high) = middle;
  }
  return (low + high) / 2;
}

std::uint32_t bits_of(PixelFilter filter, std::uint32_t samples) {
  return filter == PixelFilter::box || samples == 1 ? kStepBitsOfBox : kStepBits;
}

}  // namespace

PixelPlace pixel_place(std::uint32_t sample, std::uint32_t samples, std::uint32_t key) {
  if (samples == 1) return {0.5, 0.5};
  const auto jitter_x = static_cast<double>(protocol::uniform(key, Dimension::pixel_x));
  const auto jitter_y = static_cast<double>(protocol::uniform(key, Dimension::pixel_y));
  auto columns = static_cast<std::uint32_t>(std::sqrt(static_cast<double>(samples)));
  while (samples % columns != 0) --columns;
  if (columns > 1) {
    // Canonical arrangement of correlated multi-jittered samples (Kensler 2013): also one in each of `samples` columns
    // and rows, so that edges along the picture's axes come out smooth.
    const std::uint32_t rows = samples / columns;
    const std::uint32_t column = sample % columns;
    const std::uint32_t row = sample / columns;
    return {(column + (row + jitter_x) / rows) / columns, (row + (column + jitter_y) / columns) / rows};
  }
  // One sample in each row and each column: steps of about the golden section spread them.
  auto step = static_cast<std::uint32_t>(samples * 0.618 + 0.5);
  while (std::gcd(step, samples) != 1) ++step;
  const auto column = static_cast<std::uint32_t>(std::uint64_t{sample} * step % samples);
  return {(column + jitter_x) / samples, (sample + jitter_y) / samples};
}

double filter_distance(PixelFilter filter, double u) {
  if (filter == PixelFilter::box) return u - 0.5;
  if (filter == PixelFilter::gaussian) return gaussian_distance(u);
  return u < 0.5 ? std::sqrt(2 * u) - 1 : 1 - std::sqrt(2 * (1 - u));
}

std::uint32_t PixelSamples::entries(PixelFilter filter, std::uint32_t samples) {
  return (1U << bits_of(filter, samples)) + 1U;
}

PixelSamples::PixelSamples(PixelFilter filter, std::uint32_t samples, std::uint32_t seed)
    : filter_bits_(bits_of(filter, samples)) {
  const auto of_turn = [](double part) { return static_cast<std::uint32_t>(part * 0x1p32); };
  for (std::uint32_t sample = 0; sample < samples; ++sample) {
    const PixelPlace place = pixel_place(sample, samples, protocol::hash_combine(seed, sample));
    places_.push_back({of_turn(place.x), of_turn(place.y)});
  }
  const std::uint32_t steps = 1U << filter_bits_;
  for (std::uint32_t i = 0; i <= steps; ++i) {
    const double distance = samples == 1 ? 0 : filter_distance(filter, static_cast<double>(i) / steps);
    distances_.push_back(static_cast<float>(distance));
  }
}

PixelSamples::PixelSamples(const Quality& quality, std::uint32_t seed)
    : PixelSamples(quality.filter, quality.sample_places(), seed) {
  if (!quality.adaptive()) return;
  for (std::uint32_t sample = 0; sample < places_.size(); ++sample) {
    const protocol::StratifiedPair pair = protocol::stratified_pair(sample, seed);
    places_[sample] = {pair.x, pair.y};
  }
}

}  // namespace torolux
