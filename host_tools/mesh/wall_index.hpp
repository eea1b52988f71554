// SPDX-License-Identifier: MIT
// Walls of one triangle enter; those near a part of it leave: a floor has thousands of them, and as many elements that
// ask.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace torolux {

/// Weights of a triangle's corners 1 and 2.
struct PlanePoint {
  double b1 = 0, b2 = 0;
};
struct WallSegment {
  PlanePoint from, to;
};

/// The triangle's square of weights in cells, each with the walls that pass through it or, at the border, beyond it.
class WallIndex {
 public:
  explicit WallIndex(const std::array<std::span<const WallSegment>, 2>& walls);

  /// Whether `holds` does of any wall near a triangle; of walls that are not near it is not asked. What holds of a wall
  /// must hold only where it meets the triangle, but for rounding.
  template <typename Holds>
  bool any_near(const std::array<PlanePoint, 3>& corner, const Holds& holds) const {
    const Range range = cells_of(corner);
    for (std::uint32_t row = range.first_row; row <= range.last_row; ++row) {
      for (std::uint32_t column = range.first_column; column <= range.last_column; ++column) {
        const std::uint32_t cell = row * cells_ + column;
        for (std::uint32_t i = begin_[cell]; i < begin_[cell + 1]; ++i)
          if (holds(walls_[i])) return true;
      }
    }
    return false;
  }

 private:
  struct Range {
    std::uint32_t first_column, last_column, first_row, last_row;
  };
  std::uint32_t cell_at(double weight) const;
  Range cells_of(std::span<const PlanePoint> points) const;

  std::uint32_t cells_;               ///< along each axis
  std::vector<std::uint32_t> begin_;  ///< by cell: its first in walls_; one more than there are cells
  std::vector<WallSegment> walls_;    ///< by cell; one may be in several
};

}  // namespace torolux
