// SPDX-License-Identifier: MIT
// Where points of a plane lie to each other. Exact: coordinates are integers of at most 28 bits.
#pragma once

#include <array>
#include <cstdint>

#include "host_tools/mesh/delaunay.hpp"

namespace torolux::plane {

__extension__ using Wide = __int128;

/// Twice the area of a, b, c; positive where they run counter-clockwise.
constexpr std::int64_t turn(LatticePoint a, LatticePoint b, LatticePoint c) {
  return (std::int64_t{b.x} - a.x) * (std::int64_t{c.y} - a.y) - (std::int64_t{b.y} - a.y) * (std::int64_t{c.x} - a.x);
}

constexpr std::int64_t square(LatticePoint a, LatticePoint b) {
  const std::int64_t x = std::int64_t{b.x} - a.x;
  const std::int64_t y = std::int64_t{b.y} - a.y;
  return x * x + y * y;
}

/// Above 0 where p lies inside the circle through a counter-clockwise triangle's corners, 0 on it.
constexpr Wide in_circle(const std::array<LatticePoint, 3>& corner, LatticePoint p) {
  Wide sum = 0;
  for (std::size_t i = 0; i < 3; ++i)
    sum += Wide{square(p, corner[i])} * turn(p, corner[(i + 1) % 3], corner[(i + 2) % 3]);
  return sum;
}

}  // namespace torolux::plane
