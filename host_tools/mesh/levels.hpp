// SPDX-License-Identifier: MIT
// How finely each triangle is cut: from lengths in user units, or by themselves.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace torolux {

struct Levels {
  std::uint8_t patch = 0;
  std::uint8_t element = 0;  ///< >= patch
};

/// The least level at which `longest_edge` / 2^level <= `most`, at most kMostLevels. Both > 0.
std::uint8_t level_for(double longest_edge, double most);

/// longest_edges: of each diffuse triangle, user units. Automatic lengths aim at about 300 patches and 4,500 elements
/// for a small scene (see `data/references.md`: finer elements than the hemi-cube resolves make the picture worse) and
/// one patch, two elements more for each triangle.
std::vector<Levels> choose_levels(std::span<const double> longest_edges, std::optional<double> patch_length,
                                  std::optional<double> element_length);

}  // namespace torolux
