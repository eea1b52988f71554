// SPDX-License-Identifier: MIT
// Closed integrals over each pixel (Cohen & Greenberg 1985), as multiples of 2^-32. The few units that rounding leaves
// over go to the top's pixels.
#include "host_tools/layout/hemicube_weights.hpp"

#include <cmath>
#include <numbers>
#include <numeric>

namespace torolux {
namespace {

/// Integral over the pixel [i, i + 1] x [j, j + 1], of size 2 / n, by the factor to corner rectangles.
template <typename FormFactor>
double pixel_factor(FormFactor factor, std::uint32_t i, std::uint32_t j, std::uint32_t n) {
  const double size = 2.0 / n;
  const double x0 = i * size;
  const double x1 = (i + 1) * size;
  const double y0 = j * size;
  const double y1 = (j + 1) * size;
  return factor(x1, y1) - factor(x0, y1) - factor(x1, y0) + factor(x0, y0);
}

}  // namespace

// Both are the closed integrals of cos cos / (pi r^2): of 1 / (pi (x^2 + y^2 + 1)^2) and of z / (pi (x^2 + z^2 + 1)^2)
// (Cohen & Greenberg 1985, equations of the delta form factors).
double top_form_factor(double x, double y) {
  const double rx = std::sqrt(1 + x * x);
  const double ry = std::sqrt(1 + y * y);
  return (x / rx * std::atan(y / rx) + y / ry * std::atan(x / ry)) / (2 * std::numbers::pi);
}

double side_form_factor(double x, double z) {
  const double rz = std::sqrt(1 + z * z);
  return (std::atan(x) - std::atan(x / rz) / rz) / (2 * std::numbers::pi);
}

std::vector<std::uint32_t> make_hemicube_weights(std::uint32_t n) {
  const std::uint32_t half = n / 2;
  std::vector<std::uint32_t> weights;
  weights.reserve(std::size_t{2} * half * half);
  const auto rounded = [](double factor) { return static_cast<std::uint32_t>(std::llround(factor * 0x1p32)); };
  for (std::uint32_t j = 0; j < half; ++j) {
    for (std::uint32_t i = 0; i < half; ++i) weights.push_back(rounded(pixel_factor(top_form_factor, i, j, n)));
  }
  for (std::uint32_t j = 0; j < half; ++j) {
    for (std::uint32_t i = 0; i < half; ++i) weights.push_back(rounded(pixel_factor(side_form_factor, i, j, n)));
  }
  // Rounding leaves at most a few units over: they go to the top's pixels in turn, the heaviest ones first.
  const auto middle = weights.begin() + static_cast<std::ptrdiff_t>(half) * half;
  const std::int64_t top = std::accumulate(weights.begin(), middle, std::int64_t{0});
  const std::int64_t side = std::accumulate(middle, weights.end(), std::int64_t{0});
  std::int64_t rest = (std::int64_t{1} << 30U) - top - 2 * side;
  for (std::size_t at = 0; rest != 0; at = (at + 1) % (std::size_t{half} * half)) {
    weights[at] += rest > 0 ? 1U : ~0U;
    rest -= rest > 0 ? 1 : -1;
  }
  return weights;
}

std::vector<protocol::HemicubeEntry> make_hemicube_table(std::uint32_t n) {
  std::vector<protocol::HemicubeEntry> table;
  for (const std::uint32_t weight : make_hemicube_weights(n)) {
    table.push_back(protocol::hemicube_entry(n, static_cast<std::uint32_t>(table.size())));
    table.back().weight = weight;
  }
  return table;
}

}  // namespace torolux
