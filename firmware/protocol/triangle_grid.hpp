// SPDX-License-Identifier: MIT
// How a polygon (triangle) is cut into patches and elements. Level L cuts every edge into 2^L.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/protocol/machine.hpp"

namespace torolux::protocol {

/// Four triangles at each level: child i < 3 keeps corner i; child 3 is the middle one, its corners opposite to those.
/// A path of L digits in base 4, coarsest first, names one triangle of level L; its first P digits name the
/// level-P triangle that holds it.
inline constexpr std::uint32_t kMostLevels = 10;

constexpr std::uint32_t triangles_of_level(std::uint32_t level) {
  return 1U << (2U * level);
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

/// The middle of a triangle named by a path: weights of polygon corners 0, 1, 2, in units of a third of 2^-kMostLevels;
/// exactly the sums of its corners'. A child at a corner lies half of what its parent reaches nearer to it; the middle
/// one has its parent's middle, and reaches the other way.
constexpr std::array<std::int32_t, 3> middle_of_grid_triangle(std::uint32_t path, std::uint32_t level) {
  constexpr auto one = std::int32_t{1} << kMostLevels;
  std::array<std::int32_t, 3> nearer{};
  std::int32_t reach = one;
  for (std::uint32_t shift = 2U * level; shift > 0; shift -= 2U) {
    const std::uint32_t child = (path >> (shift - 2U)) & 3U;
    reach /= child < 3U ? 2 : -2;
    if (child < 3U) nearer[child] += reach;
  }
  const std::int32_t rest = one - (nearer[0] + nearer[1] + nearer[2]);
  return {rest + 3 * nearer[0], rest + 3 * nearer[1], rest + 3 * nearer[2]};
}

/// A path with its level in one word, by a leading 1 (I. Gargantini, "An effective way to represent quadtrees",
/// Communications of the ACM 25(12), 1982).
constexpr std::uint32_t location_code(std::uint32_t path, std::uint32_t level) {
  return triangles_of_level(level) | path;
}
constexpr std::uint32_t level_of_code(std::uint32_t code) {
  std::uint32_t level = 0;
  while (code >= 4U) {
    code >>= 2U;
    ++level;
  }
  return level;
}
constexpr std::uint32_t path_of_code(std::uint32_t code) {
  return code ^ triangles_of_level(level_of_code(code));
}

constexpr GridTriangle grid_triangle_of(std::uint32_t code) {
  return grid_triangle(path_of_code(code), level_of_code(code));
}

/// A point's weights of a triangle's corners. May be off [0, 1] by rounding.
struct Weights {
  float b0, b1, b2;
};

/// Of a triangle's four children the one that holds the point; `at` becomes its weights of that child's corners. Points
/// on an edge between two belong to the middle one.
constexpr std::uint32_t enter_child(Weights& at) {
  if (at.b0 > 0.5F) {
    at = {2.0F * at.b0 - 1.0F, 2.0F * at.b1, 2.0F * at.b2};
    return 0;
  }
  if (at.b1 > 0.5F) {
    at = {2.0F * at.b0, 2.0F * at.b1 - 1.0F, 2.0F * at.b2};
    return 1;
  }
  if (at.b2 > 0.5F) {
    at = {2.0F * at.b0, 2.0F * at.b1, 2.0F * at.b2 - 1.0F};
    return 2;
  }
  at = {1.0F - 2.0F * at.b0, 1.0F - 2.0F * at.b1, 1.0F - 2.0F * at.b2};
  return 3;
}

/// The path of the level-L triangle that holds the point; `at` becomes its weights there.
constexpr std::uint32_t enter_level(Weights& at, std::uint32_t level) {
  std::uint32_t path = 0;
  for (std::uint32_t step = 0; step < level; ++step) path = (path << 2U) | enter_child(at);
  return path;
}

/// A tree over a triangle that is cut more finely in some places than in others. A node is one word: a leaf, with a
/// number, or the index of the first of four children, which lie together behind it in the list of nodes.
inline constexpr std::uint32_t kLeaf = 0x8000'0000U;

/// The number of the leaf that holds the point; `at` becomes its weights there.
constexpr std::uint32_t find_leaf(const std::uint32_t* nodes, std::uint32_t node, Weights& at) {
  while ((node & kLeaf) == 0) node = nodes[node + enter_child(at)];
  return node & ~kLeaf;
}

/// Children that hold the point, `levels` deep, coarsest first, two bits each from the top of the word on: with them
/// another PE finds the same leaf of a tree that is no deeper.
constexpr std::uint32_t way_to_leaf(Weights& at, std::uint32_t levels) {
  std::uint32_t way = 0;
  for (std::uint32_t shift = 32; levels > 0; --levels) {
    shift -= 2U;
    way |= enter_child(at) << shift;
  }
  return way;
}
constexpr std::uint32_t leaf_on_way(const std::uint32_t* nodes, std::uint32_t node, std::uint32_t way) {
  while ((node & kLeaf) == 0) {
    node = nodes[node + (way >> 30U)];
    way <<= 2U;
  }
  return node & ~kLeaf;
}

/// The same leaf; `code` is continued by its place in the grid, from that of the triangle with which the tree begins.
constexpr std::uint32_t find_leaf(const std::uint32_t* nodes, std::uint32_t node, Weights& at, std::uint32_t& code) {
  while ((node & kLeaf) == 0) {
    const std::uint32_t child = enter_child(at);
    code = code << 2U | child;
    node = nodes[node + child];
  }
  return node & ~kLeaf;
}

/// Of a leaf's number, ray tracing stage: it stands for a part of the polygon whose surface one PE alone has, its
/// keeper: the lower 16 bits. There the tree goes on at a node of its list `StageLayout::kept`, at the place that the
/// bits between name.
inline constexpr std::uint32_t kKept = 0x4000'0000U;
inline constexpr std::uint32_t kKeptShift = 16;
inline constexpr std::uint32_t kMostKept = (kKept >> kKeptShift);

constexpr std::uint32_t kept_leaf(PeNumber keeper, std::uint32_t place) {
  return kLeaf | kKept | place << kKeptShift | keeper;
}
constexpr PeNumber keeper_of(std::uint32_t leaf) {
  return static_cast<PeNumber>(leaf & 0xFFFFU);
}
constexpr std::uint32_t kept_place(std::uint32_t leaf) {
  return (leaf & (kKept - 1U)) >> kKeptShift;
}

}  // namespace torolux::protocol
