// SPDX-License-Identifier: MIT
// A plane's points and the border of a region enter; a constrained Delaunay triangulation of the region leaves.
// Coordinates are integers, so every test is exact.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace torolux {

struct LatticePoint {
  std::int32_t x = 0, y = 0;  ///< at most kMostOfPlane in magnitude
  bool operator==(const LatticePoint&) const = default;
};
inline constexpr std::int32_t kMostOfPlane = 1 << 24;

class Triangulation {
 public:
  using Border = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  /// border: edges between points, by number, each with the region on its left; in any order. Absent: two points are
  /// one, edges cross or go through a point, or they bound no region.
  static std::optional<Triangulation> make(std::span<const LatticePoint> points, const Border& border);

  /// Of the border.
  std::span<const LatticePoint> points() const { return std::span(points_).subspan(kAround); }
  /// Of the region, counter-clockwise.
  std::vector<std::array<std::uint32_t, 3>> triangles() const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;
  static constexpr std::uint32_t kAround = 3;  // points of the triangle around everything come first
  struct Triangle {
    std::array<std::uint32_t, 3> corner;  // counter-clockwise
    std::array<std::uint32_t, 3> beside;  // the neighbour opposite each corner
    std::array<bool, 3> fixed{};          // the edge opposite each corner is of the border
    bool inside = false;
  };
  /// Two triangles and the edge between them, from a to b with `one`'s corner p on its left and `two`'s q on its right.
  struct Pair {
    std::uint32_t u, i, j;  // number of `two`; indices of p and q
    Triangle one, two;
    std::uint32_t p, a, b, q;
  };
  struct EdgePlace {
    std::uint32_t triangle, opposite;  // index of the corner opposite the edge
  };

  Triangulation();
  std::array<LatticePoint, 3> corners(const Triangle& triangle) const;
  std::uint32_t index_of(std::uint32_t triangle, std::uint32_t corner) const;
  std::uint32_t index_towards(std::uint32_t triangle, std::uint32_t neighbour) const;
  void set(std::uint32_t triangle, const Triangle& value);
  void replace_neighbour(std::uint32_t triangle, std::uint32_t old, std::uint32_t now);
  bool outside_edge(std::uint32_t triangle, std::uint32_t i, LatticePoint p) const;
  /// The edge from a to b, from the triangle on its left.
  std::optional<EdgePlace> find_edge(std::uint32_t a, std::uint32_t b) const;

  Pair pair_at(std::uint32_t triangle, std::uint32_t i) const;
  void flip(std::uint32_t triangle, std::uint32_t i);
  bool flips_well(std::uint32_t triangle, std::uint32_t i) const;
  bool is_delaunay(std::uint32_t triangle, std::uint32_t i) const;
  void make_delaunay(std::vector<EdgePlace> doubtful);

  bool add(LatticePoint point);
  void split_triangle(std::uint32_t triangle, std::uint32_t point);
  void split_edge(std::uint32_t triangle, std::uint32_t i, std::uint32_t point);
  void settle(std::uint32_t point);

  bool fix(std::uint32_t a, std::uint32_t b);
  std::optional<std::vector<std::pair<std::uint32_t, std::uint32_t>>> crossed_by(std::uint32_t a,
                                                                                 std::uint32_t b) const;
  bool fill(const Border& border);

  std::vector<LatticePoint> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> at_;  // by point, a triangle that has it as a corner
  std::uint32_t last_ = 0;         // where the last point was added
};

}  // namespace torolux
