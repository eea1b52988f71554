// SPDX-License-Identifier: MIT
// A plane's points and the border of a region enter; a constrained Delaunay triangulation of the region leaves, refined
// until no large triangle is thin. Coordinates are integers, so every test is exact.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace torolux {

struct PlanePoint {
  std::int32_t x = 0, y = 0;  ///< at most kMostOfPlane in magnitude
  bool operator==(const PlanePoint&) const = default;
};
inline constexpr std::int32_t kMostOfPlane = 1 << 24;

class Triangulation {
 public:
  using Border = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

  /// border: edges between points, by number, each with the region on its left; in any order. Absent: two points are
  /// one, edges cross or go through a point, or they bound no region.
  static std::optional<Triangulation> make(std::span<const PlanePoint> points, const Border& border);

  /// Where an edge of the border is to be halved: the new point, which gets the next number; absent: it stays whole.
  using Halve = std::function<std::optional<PlanePoint>(std::uint32_t, std::uint32_t)>;

  /// Adds points until of the triangles with an edge longer than `least` none has a circle around it of more than
  /// sqrt(2) times its shortest edge (no angle below 20.7 degrees), as far as halved edges of the border allow (J.
  /// Ruppert, A Delaunay Refinement Algorithm for Quality 2-Dimensional Mesh Generation, Journal of Algorithms 18,
  /// 1995). False: a half of an edge would be turned over, as points are only so fine; the triangulation is of no use.
  bool refine(double least, const Halve& halve);
  /// Whether refine() would add a point for a triangle with these corners.
  static bool is_thin(const std::array<PlanePoint, 3>& corner, double least);

  /// Of the border, then those that refine() added.
  std::span<const PlanePoint> points() const { return std::span(points_).subspan(kAround); }
  /// Of the region, counter-clockwise.
  std::vector<std::array<std::uint32_t, 3>> triangles() const;

 private:
  static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;
  static constexpr std::uint32_t kAround = 3;  // points of the triangle around everything come first
  struct Triangle {
    std::array<std::uint32_t, 3> corner;  // counter-clockwise
    std::array<std::uint32_t, 3> beside;  // the neighbour opposite each corner
    std::array<bool, 3> fixed;            // the edge opposite each corner is of the border
    bool inside = false;
  };
  struct EdgePlace {
    std::uint32_t triangle, opposite;  // index of the corner opposite the edge
  };

  Triangulation();
  std::array<PlanePoint, 3> corners(const Triangle& triangle) const;
  std::uint32_t index_of(std::uint32_t triangle, std::uint32_t corner) const;
  std::uint32_t index_towards(std::uint32_t triangle, std::uint32_t neighbour) const;
  void set(std::uint32_t triangle, const Triangle& value);
  void replace_neighbour(std::uint32_t triangle, std::uint32_t old, std::uint32_t now);
  bool outside_edge(std::uint32_t triangle, std::uint32_t i, PlanePoint p) const;
  /// The edge from a to b, from the triangle on its left.
  std::optional<EdgePlace> find_edge(std::uint32_t a, std::uint32_t b) const;

  void flip(std::uint32_t triangle, std::uint32_t i);
  bool flips_well(std::uint32_t triangle, std::uint32_t i) const;
  bool is_delaunay(std::uint32_t triangle, std::uint32_t i) const;
  void make_delaunay(std::vector<EdgePlace> doubtful);

  bool add(PlanePoint point);
  void split_triangle(std::uint32_t triangle, std::uint32_t point);
  bool split_edge(std::uint32_t triangle, std::uint32_t i, std::uint32_t point);
  void settle(std::uint32_t point);

  bool fix(std::uint32_t a, std::uint32_t b);
  std::optional<std::vector<std::pair<std::uint32_t, std::uint32_t>>> crossed_by(std::uint32_t a,
                                                                                 std::uint32_t b) const;
  bool fill(const Border& border);

  /// Where a point lies, seen from a triangle: `opposite` kNone in that triangle, else behind that edge of the border.
  EdgePlace look(std::uint32_t from, PlanePoint towards) const;
  /// The edges of the border that a new point would lie too near to.
  std::vector<EdgePlace> encroached(std::uint32_t triangle, PlanePoint point) const;
  bool improve(std::uint32_t triangle, const Halve& halve);
  bool halve_edge(EdgePlace edge, const Halve& halve);

  std::vector<PlanePoint> points_;
  std::vector<Triangle> triangles_;
  std::vector<std::uint32_t> at_;  // by point, a triangle that has it as a corner
  std::uint32_t last_ = 0;         // where the last point was added
  bool failed_ = false;
};

}  // namespace torolux
