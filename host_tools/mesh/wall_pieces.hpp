// SPDX-License-Identifier: MIT
// An element and its walls enter; the parts into which the walls divide it leave: each receives and shoots for itself.
#pragma once

#include <cstdint>
#include <vector>

namespace torolux {

struct Mesh;

/// A triangle of the grid below an element's.
struct WallPiece {
  std::uint32_t code = 0;  ///< protocol::location_code
  std::uint32_t part = 0;  ///< counted from 0, in the order of their first pieces
};

/// How walls part an element.
struct WallParts {
  /// In the order of their paths; they follow the walls as closely as their size allows. One piece, the element itself,
  /// where of no more than one part anything is seen.
  std::vector<WallPiece> pieces;
  struct Part {
    double area;  ///< of the element's
    bool seen;
  };
  std::vector<Part> parts;
};

/// Of a triangle of a polygon's grid.
WallParts wall_parts(const Mesh& mesh, std::uint32_t triangle, std::uint32_t code);

}  // namespace torolux
