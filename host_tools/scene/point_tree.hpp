// SPDX-License-Identifier: MIT
// Points in; those near a stretch of a line out, without a look at all others.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

/// Boxes within boxes, each with half of the points of the one around it (J. Bentley, "Multidimensional binary search
/// trees used for associative searching", 1975).
class PointTree {
 public:
  /// members: numbers of positions, which must not change while this lives.
  PointTree(std::span<const Vec3d> positions, std::vector<std::uint32_t> members);

  /// Leaves in `found` all members within `near` [scene units] of the stretch from a to b, and some that are farther
  /// away, in no order. near: must be more than rounding.
  void find_near(const Vec3d& a, const Vec3d& b, double near, std::vector<std::uint32_t>& found) const;

 private:
  struct Node {
    vec::Box box;
    std::size_t begin, end;  ///< of its members
    std::size_t second;      ///< its second half; the first stands behind it. 0: it has none
  };

  std::size_t build(std::size_t begin, std::size_t end);

  std::span<const Vec3d> positions_;
  std::vector<std::uint32_t> members_;
  std::vector<Node> nodes_;
};

}  // namespace torolux
