// SPDX-License-Identifier: MIT
// How a polygon (triangle) is cut into patches, elements and lattice vertices. Level L cuts every edge into 2^L.
#pragma once

#include <cstdint>

namespace torolux::protocol {

/// Four triangles at each level: child i < 3 keeps corner i; child 3 is the middle one, its corners opposite to those.
/// A path of L digits in base 4, coarsest first, names one triangle of level L; its first P digits name the
/// level-P triangle that holds it. So patch = path >> 2 (L - P), element of the patch = path & (4^(L-P) - 1).
inline constexpr std::uint32_t kMostLevels = 10;

constexpr std::uint32_t triangles_of_level(std::uint32_t level) {
  return 1U << (2U * level);
}
constexpr std::uint32_t lattice_size(std::uint32_t level) {
  const std::uint32_t n = 1U << level;
  return (n + 1U) * (n + 2U) / 2U;
}

/// Barycentric coordinates of corners 0, 1, 2 in units of 2^-kMostLevels of a triangle named by a path.
struct GridTriangle {
  std::int32_t corner[3][3];  ///< [corner][weight of polygon corner 0, 1, 2]; weights add up to 2^kMostLevels
};

constexpr GridTriangle grid_triangle(std::uint32_t path, std::uint32_t level) {
  constexpr std::int32_t one = 1 << kMostLevels;
  GridTriangle g{{{one, 0, 0}, {0, one, 0}, {0, 0, one}}};
  for (std::uint32_t step = level; step-- > 0U;) {
    const std::uint32_t child = (path >> (2U * step)) & 3U;
    GridTriangle next{};
    for (std::uint32_t c = 0; c < 3; ++c) {
      for (std::uint32_t w = 0; w < 3; ++w) {
        const std::int32_t mid_a = (g.corner[(c + 1U) % 3U][w] + g.corner[(c + 2U) % 3U][w]) / 2;
        next.corner[c][w] = child == 3U ? mid_a : (g.corner[c][w] + g.corner[child][w]) / 2;
      }
    }
    g = next;
  }
  return g;
}

/// The path of the level-L triangle that holds the point with weights b1, b2 of corners 1, 2 (b0 = 1 - b1 - b2).
/// Points on an edge belong to the middle triangle. Weights may be off [0, 1] by rounding.
constexpr std::uint32_t path_of_point(float b1, float b2, std::uint32_t level) {
  float b0 = 1.0F - b1 - b2;
  std::uint32_t path = 0;
  for (std::uint32_t step = 0; step < level; ++step) {
    std::uint32_t child = 3;
    if (b0 > 0.5F)
      child = 0;
    else if (b1 > 0.5F)
      child = 1;
    else if (b2 > 0.5F)
      child = 2;
    if (child == 3U) {
      b0 = 1.0F - 2.0F * b0;
      b1 = 1.0F - 2.0F * b1;
      b2 = 1.0F - 2.0F * b2;
    } else {
      b0 = 2.0F * b0 - (child == 0U ? 1.0F : 0.0F);
      b1 = 2.0F * b1 - (child == 1U ? 1.0F : 0.0F);
      b2 = 2.0F * b2 - (child == 2U ? 1.0F : 0.0F);
    }
    path = (path << 2U) | child;
  }
  return path;
}

/// Lattice vertex (i, j): weights of corners 1, 2 are i/n, j/n, n = 2^level, i + j <= n. Rows of constant j, j rising.
constexpr std::uint32_t lattice_index(std::uint32_t i, std::uint32_t j, std::uint32_t level) {
  const std::uint32_t n = 1U << level;
  return j * (n + 1U) - (j * (j - (j > 0U ? 1U : 0U))) / 2U + i;
}
static_assert(lattice_index(0, 0, 2) == 0 && lattice_index(4, 0, 2) == 4 && lattice_index(0, 1, 2) == 5);
static_assert(lattice_index(0, 2, 2) == 9 && lattice_index(0, 4, 2) == 14 && lattice_size(2) == 15);

}  // namespace torolux::protocol
