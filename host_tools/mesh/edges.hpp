// SPDX-License-Identifier: MIT
// Triangles by position enter; their edges leave, in an order in which triangles that share one are found.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <span>
#include <vector>

namespace torolux {

/// Edge `index` of a triangle runs from corner index to corner (index + 1) % 3.
struct EdgeUse {
  std::uint32_t low, high;  ///< positions, low < high
  std::uint32_t triangle;
  std::uint8_t edge;
  bool forward;  ///< runs from low to high

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes the comparison with 0 inside for a pointer
  auto operator<=>(const EdgeUse&) const = default;
};

/// All edges of all triangles, sorted, so that uses of the same edge lie together.
std::vector<EdgeUse> edge_uses(std::span<const std::array<std::uint32_t, 3>> triangles);

/// Calls visit(span of the uses of one edge) for each edge.
template <typename Visit>
void for_each_edge(std::span<const EdgeUse> uses, Visit visit) {
  for (std::size_t begin = 0; begin < uses.size();) {
    std::size_t end = begin + 1;
    while (end < uses.size() && uses[end].low == uses[begin].low && uses[end].high == uses[begin].high) ++end;
    visit(uses.subspan(begin, end - begin));
    begin = end;
  }
}

/// Sets that merge; the root of a set is its lowest member.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t members);
  std::uint32_t root(std::uint32_t member);
  void merge(std::uint32_t a, std::uint32_t b);

 private:
  std::vector<std::uint32_t> parent_;
};

}  // namespace torolux
