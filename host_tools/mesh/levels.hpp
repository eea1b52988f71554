// SPDX-License-Identifier: MIT
// Triangles enter; leaves: how long patches and elements are, and how finely each triangle is cut for it.
#pragma once

#include <cstdint>
#include <span>

namespace torolux {

/// The least level at which `longest_edge` / 2^level <= `most`, at most kMostLevels. Both > 0.
std::uint8_t level_for(double longest_edge, double most);

/// What is to be cut: a triangle with sides.
struct CutTriangle {
  double longest_edge = 0;  ///< [user units]
  double area = 0;          ///< [user units^2]
};

/// [user units]
struct MeshLengths {
  double patch = 0, element = 0;
  double cluster = 0;  ///< elements of several small triangles each
};

/// Lengths that make about 300 patches and 4,500 elements of a small scene (see `data/references.md`: finer elements
/// than the hemi-cube resolves make the picture worse) and one patch, two elements more for each smooth surface.
/// triangles: not empty. surfaces: smooth ones, each of which needs a patch at least.
MeshLengths choose_lengths(std::span<const CutTriangle> triangles, std::uint32_t surfaces);

}  // namespace torolux
