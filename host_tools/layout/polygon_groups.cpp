// SPDX-License-Identifier: MIT
// Halves along the longest edge of what the middles of the polygons' boxes span, until few are left; an entry with the
// box around them all stands before each group.
#include "host_tools/layout/polygon_groups.hpp"

#include <algorithm>
#include <array>

namespace torolux {
namespace {

using protocol::ListedPolygon;

/// The most polygons of a group; up to so many in a subspace need none. With 4, scenes/interior takes up to 5 % more
/// cycles of traversal.
constexpr std::size_t kMostInGroup = 8;

std::uint64_t groups_of(std::size_t polygons) {
  if (polygons <= kMostInGroup) return 1;
  return groups_of(polygons / 2) + groups_of(polygons - polygons / 2);
}

/// Twice the middle of a box along an axis, in its parts.
std::uint32_t middle_of(const ListedPolygon& entry, std::uint32_t axis) {
  return protocol::lowest_part(entry.box, axis) + protocol::highest_part(entry.box, axis);
}

std::uint32_t longest_axis(std::span<const ListedPolygon> entries) {
  std::array<std::uint32_t, 3> length{};
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const auto [least, most] = std::ranges::minmax(entries, [axis](const ListedPolygon& a, const ListedPolygon& b) {
      return middle_of(a, axis) < middle_of(b, axis);
    });
    length[axis] = middle_of(most, axis) - middle_of(least, axis);
  }
  return static_cast<std::uint32_t>(std::max_element(length.begin(), length.end()) - length.begin());
}

void group(std::span<ListedPolygon> entries, std::vector<ListedPolygon>& out) {
  if (entries.size() <= kMostInGroup) {
    protocol::PackedBox box = entries.front().box;
    for (const ListedPolygon& entry : entries) box = protocol::box_around(box, entry.box);
    out.push_back({box, protocol::kGroup | static_cast<std::uint32_t>(entries.size())});
    out.insert(out.end(), entries.begin(), entries.end());
    return;
  }
  const std::uint32_t axis = longest_axis(entries);
  std::sort(entries.begin(), entries.end(), [axis](const ListedPolygon& a, const ListedPolygon& b) {
    const std::uint32_t at_a = middle_of(a, axis);
    const std::uint32_t at_b = middle_of(b, axis);
    return at_a != at_b ? at_a < at_b : a.polygon < b.polygon;
  });
  group(entries.first(entries.size() / 2), out);
  group(entries.subspan(entries.size() / 2), out);
}

}  // namespace

std::uint64_t listed_entries(std::size_t polygons) {
  return polygons + (polygons > kMostInGroup ? groups_of(polygons) : 0);
}

std::vector<ListedPolygon> list_polygons(std::span<const MeshTriangle> triangles,
                                         std::span<const std::uint32_t> polygons, const Grid& grid, CellIndex cell) {
  std::vector<ListedPolygon> entries;
  for (const std::uint32_t t : polygons) {
    entries.push_back({protocol::box_in_cell(triangles[t].corner, grid.cell_size, grid.cell(cell)), t});
  }
  if (entries.size() <= kMostInGroup) return entries;
  std::vector<ListedPolygon> out;
  group(entries, out);
  return out;
}

}  // namespace torolux
