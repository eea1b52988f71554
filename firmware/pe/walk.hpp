// SPDX-License-Identifier: MIT
// The walk of a ray through the grid of subspaces: distances to the planes between them, and which face comes next.
// Every PE computes a plane's distance from the same numbers by the same formula: so the intervals (t_in, t_out] of the
// subspaces along a ray meet exactly, wherever it is handed on.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "firmware/pe/segment.hpp"
#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

inline float plane(const protocol::StageLayout& layout, std::uint32_t axis, std::uint32_t index) {
  return static_cast<float>(index) * layout.cell_size[axis];
}

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
  /// segment.subspace is `here`.
  Walk(const protocol::StageLayout& layout, const Segment& segment, const protocol::Subspace& here)
      : layout_(layout), origin_(to_array(segment.origin)), inverse_(segment.direction) {
    for (std::uint32_t a = 0; a < 3; ++a) aim(a, here.cell[a]);
    if (!segment.first) {
      const std::uint32_t a = segment.entry_axis;
      entered_ = distance(a, here.cell[a] + (inverse_.upward[a] ? 0U : 1U));
    }
    choose();
  }

  /// Where the ray leaves the subspace: the face whose plane is met first, x before y before z.
  std::uint32_t exit_axis() const { return axis_; }
  std::uint32_t exit_face() const { return 2U * axis_ + (inverse_.upward[axis_] ? 1U : 0U); }
  /// The face of a subspace through which this ray enters along `axis`.
  std::uint32_t entry_face(std::uint32_t axis) const { return 2U * axis + (inverse_.upward[axis] ? 0U : 1U); }
  /// The interval of the subspace is (t_in, t_out]. t_in means nothing in the first one.
  float t_in() const { return entered_; }
  float t_out() const { return exit_[axis_]; }
  const Inverse& inverse() const { return inverse_; }

  /// Goes through the exit face into `next`.
  void cross(const protocol::Subspace& next) {
    entered_ = exit_[axis_];
    aim(axis_, next.cell[axis_]);
    choose();
  }

 private:
  float distance(std::uint32_t axis, std::uint32_t index) const {
    const float inverse = inverse_.axis[axis];
    if (bits(inverse) == 0) return std::numeric_limits<float>::infinity();
    return (plane(layout_, axis, index) - origin_[axis]) * inverse;
  }
  void aim(std::uint32_t axis, std::uint32_t cell) {
    exit_[axis] = distance(axis, cell + (inverse_.upward[axis] ? 1U : 0U));
    order_[axis] = ordered(exit_[axis]);
  }
  void choose() {
    axis_ = order_[1] < order_[0] ? 1U : 0U;
    if (order_[2] < order_[axis_]) axis_ = 2U;
  }

  const protocol::StageLayout& layout_;
  protocol::Vec3f origin_;
  Inverse inverse_;
  float entered_ = 0.0F;
  std::array<float, 3> exit_;
  std::array<std::int32_t, 3> order_;
  std::uint32_t axis_ = 0;
};

/// The face through which a seeking record goes on from the subspace at `cell` towards the one that holds its origin
/// (x, then y, then z), or kFaces: it is there. Points outside the object space belong to the nearest subspace.
inline std::uint32_t seek_face(const protocol::StageLayout& layout, const glm::vec3& origin,
                               const std::array<std::uint16_t, 3>& cell) {
  for (std::uint32_t a = 0; a < 3; ++a) {
    const float x = origin[static_cast<int>(a)];
    if (cell[a] > 0 && x < plane(layout, a, cell[a])) return 2U * a;
    if (cell[a] + 1U < layout.cells[a] && x >= plane(layout, a, cell[a] + 1U)) return 2U * a + 1U;
  }
  return protocol::kFaces;
}

}  // namespace torolux::pe
