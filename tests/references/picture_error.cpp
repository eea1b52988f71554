// SPDX-License-Identifier: MIT
// Means without and with a cut at the reference's 97th percentile; with it, the relative RMSE of blocks of 4 x 4
// pixels. The noise is that of the reference's two halves.
#include "tests/references/picture_error.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace torolux::references {
namespace {

constexpr std::uint32_t kBlock = 4;

std::vector<double> values_of(const Picture& picture) {
  std::vector<double> values;
  for (const auto& pixel : picture.pixels) {
    for (const float channel : pixel) values.push_back(static_cast<double>(channel));
  }
  return values;
}

double percentile_97(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(0.97 * static_cast<double>(values.size() - 1))];
}

double sum(const std::vector<double>& values) {
  double total = 0;
  for (const double value : values) total += value;
  return total;
}

/// Means of blocks by row, column and channel; those at the right and lower edges are of fewer pixels.
std::vector<double> block_means(const std::vector<double>& values, std::uint32_t width, std::uint32_t height) {
  const std::uint32_t columns = (width + kBlock - 1) / kBlock;
  const std::uint32_t rows = (height + kBlock - 1) / kBlock;
  std::vector<double> total(std::size_t{3} * columns * rows, 0);
  std::vector<double> count(total.size(), 0);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const std::size_t pixel = i / 3;
    const std::size_t block = (pixel / width / kBlock) * columns + pixel % width / kBlock;
    total[3 * block + i % 3] += values[i];
    count[3 * block + i % 3] += 1;
  }
  for (std::size_t i = 0; i < total.size(); ++i) total[i] /= count[i];
  return total;
}

}  // namespace

PictureError picture_error(const Picture& picture, const Picture& reference) {
  std::vector<double> is = values_of(picture);
  std::vector<double> should = values_of(reference);
  PictureError error{};
  error.plain_mean = sum(is) / sum(should) - 1;
  error.clamp = percentile_97(should);
  for (auto* values : {&is, &should}) {
    for (double& value : *values) value = std::min(value, error.clamp);
  }
  error.mean = sum(is) / sum(should) - 1;
  is = block_means(is, picture.width, picture.height);
  should = block_means(should, reference.width, reference.height);
  double difference = 0;
  double square = 0;
  for (std::size_t i = 0; i < is.size(); ++i) {
    difference += (is[i] - should[i]) * (is[i] - should[i]);
    square += should[i] * should[i];
  }
  error.rmse = std::sqrt(difference / square);
  return error;
}

double reference_noise(const TracedPicture& reference) {
  return picture_error(reference.first_half, reference.second_half).rmse / 2;
}

}  // namespace torolux::references
