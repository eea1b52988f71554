// SPDX-License-Identifier: MIT
// A mask and a triangle's texture points enter; the parts of the triangle that the mask leaves, as triangles, leave.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace torolux {

/// What of a period of a texture is there: alpha of one half and more. Cells, row by row, the lowest first.
struct CutOutMask {
  std::uint32_t width = 0, height = 0;
  std::vector<bool> there;
};

/// Longest edge of a mask: finer images are averaged, each cell over what it stands for.
inline constexpr std::uint32_t kMostMaskEdge = 64;
/// Cells that a triangle may lie over: beyond that its texture repeats too often.
inline constexpr double kMostMaskCells = 1'000'000;

/// alpha: of an image, the lowest row first, 0..255.
CutOutMask cut_out_mask(std::span<const std::uint8_t> alpha, std::uint32_t width, std::uint32_t height);

/// Weights of the triangle's three corners at a corner of a part.
using CutOutCorner = std::array<double, 3>;
using CutOutPart = std::array<CutOutCorner, 3>;

/// points: texture points (u, v) of the corners; the mask repeats with period 1. Absent: all of the triangle is there.
/// Cells that are there are joined to rectangles, and these cut to the triangle; parts keep its winding.
/// Throws std::length_error where the triangle lies over more than kMostMaskCells, or too far away.
std::optional<std::vector<CutOutPart>> cut_out(const CutOutMask& mask,
                                               const std::array<std::array<double, 2>, 3>& points);

}  // namespace torolux
