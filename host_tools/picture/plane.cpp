// SPDX-License-Identifier: MIT
// Filters that are one factor across times one factor down, in two passes.
#include "host_tools/picture/plane.hpp"

#include <algorithm>
#include <cmath>

namespace torolux {
namespace {

/// Of `count` values that lie `step` apart from `first` on; results likewise.
void filter_line(const Plane& from, Plane& to, std::size_t first, std::size_t step, std::uint32_t count,
                 std::span<const double> weights) {
  const auto reach = static_cast<std::int64_t>(weights.size() / 2);
  const std::int64_t last = std::int64_t{count} - 1;
  for (std::int64_t i = 0; i <= last; ++i) {
    double sum = 0;
    for (std::int64_t k = -reach; k <= reach; ++k) {
      const auto neighbour = static_cast<std::size_t>(std::clamp<std::int64_t>(i + k, 0, last));
      sum += weights[static_cast<std::size_t>(k + reach)] * double{from.values[first + neighbour * step]};
    }
    to.values[first + static_cast<std::size_t>(i) * step] = static_cast<float>(sum);
  }
}

}  // namespace

std::vector<double> gaussian_weights(double sigma, int n) {
  std::vector<double> weights;
  double sum = 0;
  for (int i = -n; i <= n; ++i) {
    weights.push_back(std::exp(-i * i / (2 * sigma * sigma)));
    sum += weights.back();
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

Plane filter(const Plane& plane, std::span<const double> across, std::span<const double> down) {
  Plane rows(plane.width, plane.height);
  for (std::uint32_t y = 0; y < plane.height; ++y) {
    filter_line(plane, rows, std::size_t{y} * plane.width, 1, plane.width, across);
  }
  Plane result(plane.width, plane.height);
  for (std::uint32_t x = 0; x < plane.width; ++x) filter_line(rows, result, x, plane.width, plane.height, down);
  return result;
}

Plane halve(const Plane& plane) {
  Plane half((plane.width + 1) / 2, (plane.height + 1) / 2);
  for (std::uint32_t y = 0; y < half.height; ++y) {
    for (std::uint32_t x = 0; x < half.width; ++x) {
      const std::uint32_t x_end = std::min(plane.width, 2 * x + 2);
      const std::uint32_t y_end = std::min(plane.height, 2 * y + 2);
      float sum = 0;
      for (std::uint32_t v = 2 * y; v < y_end; ++v) {
        for (std::uint32_t u = 2 * x; u < x_end; ++u) sum += plane.values[std::size_t{v} * plane.width + u];
      }
      half.values[std::size_t{y} * half.width + x] = sum / static_cast<float>((x_end - 2 * x) * (y_end - 2 * y));
    }
  }
  return half;
}

}  // namespace torolux
