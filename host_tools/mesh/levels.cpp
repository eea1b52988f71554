// SPDX-License-Identifier: MIT
// A wanted number of elements enters; a search over the longest edge times powers of 2^(1/4) finds the length that
// comes nearest. A level halves edges until none is longer.
#include "host_tools/mesh/levels.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/protocol/triangle_grid.hpp"

namespace torolux {
namespace {

/// Area of an equilateral triangle with edges of length 1: what is smaller shares an element with its neighbours.
constexpr double kEquilateral = 0.4330127018922193;

double count_for(std::span<const CutTriangle> triangles, double most) {
  double sum = 0;
  for (const CutTriangle& triangle : triangles) {
    const std::uint8_t level = level_for(triangle.longest_edge, most);
    sum += level > 0 ? std::ldexp(1.0, 2 * level) : std::min(1.0, triangle.area / (kEquilateral * most * most));
  }
  return sum;
}

/// The length whose count is nearest to `target` by ratio, among the longest edge times powers of 2^(1/4).
double length_for(std::span<const CutTriangle> triangles, double target) {
  double longest = 0;
  double area = 0;
  for (const CutTriangle& triangle : triangles) {
    longest = std::max(longest, triangle.longest_edge);
    area += triangle.area;
  }
  // Where all triangles are small, longer than any of them.
  const auto above = static_cast<int>(std::ceil(4 * std::log2(std::max(1.0, std::sqrt(2 * area) / longest))));
  double best = longest;
  double best_ratio = HUGE_VAL;
  for (int step = -above; step <= 4 * static_cast<int>(protocol::kMostLevels); ++step) {
    // A little above the fraction, so that edges equal but for rounding get the same level.
    const double length = longest * std::exp2(-0.25 * step) * (1 + 1e-9);
    const double count = count_for(triangles, length);
    const double ratio = count > target ? count / target : target / count;
    if (ratio < best_ratio) {
      best = length;
      best_ratio = ratio;
    }
    if (count > target) break;
  }
  return best;
}

}  // namespace

std::uint8_t level_for(double longest_edge, double most) {
  std::uint8_t level = 0;
  while (level < protocol::kMostLevels && longest_edge > most) {
    longest_edge /= 2;
    ++level;
  }
  return level;
}

MeshLengths choose_lengths(std::span<const CutTriangle> triangles, std::uint32_t surfaces) {
  return {length_for(triangles, 300.0 + surfaces), length_for(triangles, 4500.0 + 2.0 * surfaces)};
}

}  // namespace torolux
