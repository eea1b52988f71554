// SPDX-License-Identifier: MIT
// Halves points along their box's longest edge; passes over boxes that a line does not come near.
#include "host_tools/scene/point_tree.hpp"

#include <algorithm>
#include <utility>

namespace torolux {
namespace {

constexpr std::size_t kMostInLeaf = 8;

/// Whether part of the stretch lies in the box, widened by `near`.
bool passes(const vec::Box& box, const Vec3d& a, const Vec3d& along, double near) {
  double from = 0;
  double to = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double low = box.low[axis] - near - a[axis];
    const double high = box.high[axis] + near - a[axis];
    if (along[axis] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const auto [enters, leaves] = std::minmax({low / along[axis], high / along[axis]});
    from = std::max(from, enters);
    to = std::min(to, leaves);
  }
  return from <= to;
}

}  // namespace

PointTree::PointTree(std::span<const Vec3d> positions, std::vector<std::uint32_t> members)
    : positions_(positions), members_(std::move(members)) {
  build(0, members_.size());
}

std::size_t PointTree::build(std::size_t begin, std::size_t end) {
  const std::size_t number = nodes_.size();
  Node node{{}, begin, end, 0};
  for (std::size_t i = begin; i < end; ++i) node.box.include(positions_[members_[i]]);
  nodes_.push_back(node);
  if (end - begin <= kMostInLeaf) return number;
  const Vec3d extent = node.box.extent();
  const auto axis = static_cast<std::size_t>(std::ranges::max_element(extent) - extent.begin());
  const auto at = [&](std::size_t i) { return members_.begin() + static_cast<std::ptrdiff_t>(i); };
  const std::size_t middle = begin + (end - begin) / 2;
  std::ranges::nth_element(at(begin), at(middle), at(end), {}, [&](std::uint32_t p) { return positions_[p][axis]; });
  build(begin, middle);
  nodes_[number].second = build(middle, end);
  return number;
}

void PointTree::find_near(const Vec3d& a, const Vec3d& b, double near, std::vector<std::uint32_t>& found) const {
  found.clear();
  const Vec3d along = vec::subtract(b, a);
  std::vector<std::size_t> open{0};
  while (!open.empty()) {
    const std::size_t number = open.back();
    const Node& node = nodes_[number];
    open.pop_back();
    // Twice, so that rounding does not matter.
    if (!passes(node.box, a, along, 2 * near)) continue;
    if (node.second != 0) {
      open.push_back(node.second);
      open.push_back(number + 1);
    } else {
      for (std::size_t i = node.begin; i < node.end; ++i) found.push_back(members_[i]);
    }
  }
}

}  // namespace torolux
