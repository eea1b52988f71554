// SPDX-License-Identifier: MIT
// See pixel_samples.hpp.
#include "host_tools/stages/pixel_samples.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "firmware/protocol/random.hpp"

namespace torolux {
namespace {

using protocol::Dimension;

/// Of the table from which distances are read; between two of them they are straight to 1e-6 pixels but at the ends.
constexpr std::uint32_t kSteps = 4096;
constexpr double kGaussianReach = 1.5;  ///< [pixels]
constexpr double kGaussianWidth = 0.5;  ///< standard deviation [pixels]

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

}  // namespace

std::string_view name_of(PixelFilter filter) {
  return kPixelFilters[static_cast<std::size_t>(filter)].name;
}

std::optional<PixelFilter> filter_named(std::string_view name) {
  for (const FilterName& known : kPixelFilters) {
    if (known.name == name) return known.filter;
  }
  return std::nullopt;
}

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

PixelSamples::PixelSamples(PixelFilter filter, std::uint32_t samples, std::uint32_t seed) {
  for (std::uint32_t sample = 0; sample < samples; ++sample) {
    uniform_.push_back(pixel_place(sample, samples, protocol::hash_combine(seed, sample)));
  }
  if (samples == 1) return;  // all in their pixels' middles
  for (std::uint32_t i = 0; i <= kSteps; ++i) {
    distances_.push_back(filter_distance(filter, static_cast<double>(i) / kSteps));
  }
}

double PixelSamples::distance(double u) const {
  const double at = u * kSteps;
  const auto below = std::min(static_cast<std::uint32_t>(at), kSteps - 1);
  return distances_[below] + (distances_[below + 1] - distances_[below]) * (at - below);
}

PixelPlace PixelSamples::place(std::uint32_t column, std::uint32_t row, std::uint32_t sample) const {
  if (uniform_.size() == 1) return {0.5, 0.5};
  // Powers of the reciprocals of the numbers that solve x^3 = x + 1 and x^4 = x + 1.
  const auto moved = [column, row](double u, double by_column, double by_row) {
    const double sum = u + by_column * column + by_row * row;
    return sum - std::floor(sum);
  };
  return {0.5 + distance(moved(uniform_[sample].x, 0.7548776662466927, 0.5698402909980532)),
          0.5 + distance(moved(uniform_[sample].y, 0.8191725133961645, 0.6710436067037893))};
}

}  // namespace torolux
