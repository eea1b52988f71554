// SPDX-License-Identifier: MIT
// See levels.hpp.
#include "host_tools/mesh/levels.hpp"

#include <algorithm>
#include <cmath>

#include "firmware/protocol/triangle_grid.hpp"

namespace torolux {
namespace {

double count_for(std::span<const double> longest_edges, double most) {
  double sum = 0;
  for (const double edge : longest_edges) sum += std::ldexp(1.0, 2 * level_for(edge, most));
  return sum;
}

/// The length whose count is nearest to `target` by ratio, among the longest edge divided by powers of 2^(1/4).
double length_for(std::span<const double> longest_edges, double target) {
  const double longest = *std::max_element(longest_edges.begin(), longest_edges.end());
  double best = longest;
  double best_ratio = HUGE_VAL;
  for (std::uint32_t step = 0; step <= 4 * protocol::kMostLevels; ++step) {
    // A little above the fraction, so that edges equal but for rounding get the same level.
    const double length = longest * std::exp2(-0.25 * step) * (1 + 1e-9);
    const double count = count_for(longest_edges, length);
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

std::vector<Levels> choose_levels(std::span<const double> longest_edges, std::optional<double> patch_length,
                                  std::optional<double> element_length) {
  std::vector<Levels> levels;
  if (longest_edges.empty()) return levels;
  const auto triangles = static_cast<double>(longest_edges.size());
  const double patch = patch_length ? *patch_length : length_for(longest_edges, 300 + triangles);
  const double element = element_length ? *element_length : length_for(longest_edges, 4500 + 2 * triangles);
  levels.reserve(longest_edges.size());
  for (const double edge : longest_edges) {
    Levels level;
    level.patch = level_for(edge, patch);
    level.element = std::max(level.patch, level_for(edge, element));
    levels.push_back(level);
  }
  return levels;
}

}  // namespace torolux
