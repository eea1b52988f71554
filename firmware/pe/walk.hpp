// SPDX-License-Identifier: MIT
// The walk of a ray through the grid of subspaces: distances to the planes between them, and which face comes next.
// Every PE computes a plane's distance from the same numbers by the same formula: so the intervals (t_in, t_out] of the
// subspaces along a ray meet exactly, wherever it is handed on, and whoever steps over what is empty.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "firmware/pe/cell_map.hpp"
#include "firmware/pe/segment.hpp"
#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

/// 1 / direction by axis; 0 stands for "never meets a plane of this axis" (|d| < 2^-64: t ends before 2).
struct Inverse {
  explicit Inverse(const glm::vec3& direction) {
    constexpr std::int32_t least = std::bit_cast<std::int32_t>(0x1p-64F);
    for (int a = 0; a < 3; ++a) {
      const float d = direction[a];
      const bool meets = (bits(d) & 0x7FFF'FFFF) >= least;
      axis[static_cast<std::size_t>(a)] = meets ? 1.0F / d : 0.0F;
      upward[static_cast<std::size_t>(a)] = bits(d) >= 0;
    }
  }
  std::array<float, 3> axis;
  std::array<bool, 3> upward;
};

class Walk {
 public:
  Walk(const protocol::StageLayout& layout, const Segment& segment)
      : layout_(layout),
        inverse_(segment.direction),
        index_(cell_index(layout, segment.place)),
        first_(segment.first),
        entry_axis_(segment.entry_axis) {
    std::uint32_t stride = 1;
    for (std::uint32_t a = 0; a < 3; ++a) {
      Axis& axis = axis_[a];
      const bool upward = inverse_.upward[a];
      const std::uint32_t cell = protocol::cell_along(segment.place, a);
      axis.origin = segment.origin[static_cast<int>(a)];
      axis.inverse = inverse_.axis[a];
      axis.size = layout.cell_size[a];
      axis.flip = upward ? ~0U : 0U;
      axis.mirror = upward ? layout.cells[a] : 0U;
      axis.left = upward ? layout.cells[a] - 1U - cell : cell;
      axis.stride = upward ? stride : 0U - stride;
      axis.step = upward ? 1.0F : -1.0F;
      axis.plane = static_cast<float>(cell + (upward ? 1U : 0U));
      axis.exit = distance(axis, axis.plane);
      stride *= layout.cells[a];
    }
    if (!first_) entered_ = distance(axis_[entry_axis_], axis_[entry_axis_].plane - axis_[entry_axis_].step);
  }

  /// Of the cell, in the map.
  std::uint32_t index() const { return index_; }
  protocol::CellCode place() const { return protocol::cell_code(cell_along(0), cell_along(1), cell_along(2)); }
  std::uint32_t cell_along(std::uint32_t axis) const {
    const Axis& a = axis_[axis];
    return (a.left ^ a.flip) + a.mirror;
  }
  /// Still in the cell where the segment began: then no face was entered.
  bool first() const { return first_; }
  std::uint8_t entry_axis() const { return entry_axis_; }
  /// The face through which it came, or goes next, is one of the object space's own.
  bool came_from_outside() const { return axis_[entry_axis_].left == layout_.cells[entry_axis_] - 1U; }
  bool goes_outside() const { return axis_[exit_axis()].left == 0; }
  /// The interval of the subspace is (t_in, t_out]. t_in means nothing in the first one.
  float t_in() const { return entered_; }
  float t_out() const { return axis_[exit_axis()].exit; }
  const Inverse& inverse() const { return inverse_; }

  /// Goes on to the next cell at which it must stop, through the faces whose planes are met first, x before y before z.
  /// False: it has left the object space.
  bool advance(const CellMap& map) {
    // Copies: the loop is where a ray in wide rooms spends its time, and all of it fits the registers.
    Axis x = axis_[0];
    Axis y = axis_[1];
    Axis z = axis_[2];
    const protocol::CellWord* const words = map.words.data();
    std::uint32_t index = index_;
    float entered = 0.0F;
    std::uint8_t crossed = 0;
    bool inside = true;
    do {
      if (y.exit < x.exit) {
        if (z.exit < y.exit) {
          inside = cross(z, index, entered);
          crossed = 2;
        } else {
          inside = cross(y, index, entered);
          crossed = 1;
        }
      } else if (z.exit < x.exit) {
        inside = cross(z, index, entered);
        crossed = 2;
      } else {
        inside = cross(x, index, entered);
        crossed = 0;
      }
      if (!inside) return false;
    } while (((words[index >> 5U].stops >> (index & 31U)) & 1U) == 0);
    keep(axis_[0], x);
    keep(axis_[1], y);
    keep(axis_[2], z);
    index_ = index;
    entered_ = entered;
    entry_axis_ = crossed;
    first_ = false;
    return true;
  }

 private:
  struct Axis {
    float origin, inverse, size;
    float plane;                 ///< number of the plane through which the ray leaves the cell
    float step;                  ///< to the next one: 1 or -1
    float exit;                  ///< distance to it
    std::uint32_t left;          ///< cells that lie behind it
    std::uint32_t stride;        ///< to the next cell's index
    std::uint32_t flip, mirror;  ///< (left ^ flip) + mirror is the cell: upward that is cells - 1 - left
  };

  /// As GridShape::plane: a product of two floats.
  static float distance(const Axis& axis, float plane) {
    if (bits(axis.inverse) == 0) return std::numeric_limits<float>::infinity();
    return (plane * axis.size - axis.origin) * axis.inverse;
  }
  /// Through a plane that is met, so `inverse` is not 0.
  [[gnu::always_inline]] static bool cross(Axis& axis, std::uint32_t& index, float& entered) {
    if (axis.left == 0) return false;
    --axis.left;
    index += axis.stride;
    entered = axis.exit;
    axis.plane += axis.step;
    axis.exit = (axis.plane * axis.size - axis.origin) * axis.inverse;
    return true;
  }
  /// What changes on the way.
  [[gnu::always_inline]] static void keep(Axis& axis, const Axis& now) {
    axis.plane = now.plane;
    axis.exit = now.exit;
    axis.left = now.left;
  }
  std::uint32_t exit_axis() const {
    const std::uint32_t axis = axis_[1].exit < axis_[0].exit ? 1U : 0U;
    return axis_[2].exit < axis_[axis].exit ? 2U : axis;
  }

  const protocol::StageLayout& layout_;
  Inverse inverse_;
  std::array<Axis, 3> axis_;
  float entered_ = 0.0F;
  std::uint32_t index_;
  bool first_;
  std::uint8_t entry_axis_;
};

}  // namespace torolux::pe
