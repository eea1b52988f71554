// SPDX-License-Identifier: MIT
// Joins cells of a mask to rectangles, and cuts these to a triangle (Sutherland and Hodgman 1974).
#include "host_tools/scene/cut_out.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

namespace torolux {
namespace {

using Point = std::array<double, 2>;

/// Twice the area of a triangle; above 0: counter-clockwise.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Cells from low, inclusive, to high, exclusive.
struct Rectangle {
  std::int64_t low_x, low_y, high_x, high_y;
};

/// Where the mask lies over a triangle: positions are cells from its lowest left corner.
class Cells {
 public:
  Cells(const CutOutMask& mask, const std::array<Point, 3>& corners) : mask_(mask) {
    for (std::size_t axis = 0; axis < 2; ++axis) {
      const auto [least, most] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
      low_[axis] = static_cast<std::int64_t>(std::floor(least));
      high_[axis] = std::max(low_[axis] + 1, static_cast<std::int64_t>(std::ceil(most)));
    }
  }

  bool there(std::int64_t x, std::int64_t y) const {
    const auto wrapped = [](std::int64_t value, std::int64_t period) { return ((value % period) + period) % period; };
    return mask_.there[static_cast<std::size_t>(wrapped(y, mask_.height) * mask_.width + wrapped(x, mask_.width))];
  }

  bool all() const {
    for (std::int64_t y = low_[1]; y < high_[1]; ++y)
      for (std::int64_t x = low_[0]; x < high_[0]; ++x)
        if (!there(x, y)) return false;
    return true;
  }

  /// Runs of each row, joined upwards with equal ones.
  std::vector<Rectangle> rectangles() const {
    std::vector<Rectangle> done;
    std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> growing;  // begin and end of a run: its lowest row
    const auto finish = [&done](const auto& run, std::int64_t row) {
      done.push_back({run.first.first, run.second, run.first.second, row});
    };
    for (std::int64_t y = low_[1]; y < high_[1]; ++y) {
      std::map<std::pair<std::int64_t, std::int64_t>, std::int64_t> next;
      for (std::int64_t x = low_[0]; x < high_[0]; ++x) {
        if (!there(x, y)) continue;
        const std::int64_t begin = x;
        while (x < high_[0] && there(x, y)) ++x;
        const auto below = growing.find({begin, x});
        next.emplace(std::pair(begin, x), below == growing.end() ? y : below->second);
        if (below != growing.end()) growing.erase(below);
      }
      for (const auto& run : growing) finish(run, y);
      growing = std::move(next);
    }
    for (const auto& run : growing) finish(run, high_[1]);
    return done;
  }

 private:
  const CutOutMask& mask_;
  std::array<std::int64_t, 2> low_{}, high_{};
};

/// What of a convex polygon lies to the left of a line from `a` to `b`.
std::vector<Point> left_of(const std::vector<Point>& polygon, const Point& a, const Point& b) {
  std::vector<Point> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Point& p = polygon[i];
    const Point& q = polygon[(i + 1) % polygon.size()];
    const double here = turn(a, b, p);
    const double there = turn(a, b, q);
    if (here >= 0) kept.push_back(p);
    if ((here > 0 && there < 0) || (here < 0 && there > 0)) {
      const double t = here / (here - there);
      kept.push_back({p[0] + t * (q[0] - p[0]), p[1] + t * (q[1] - p[1])});
    }
  }
  return kept;
}

}  // namespace

CutOutMask cut_out_mask(std::span<const std::uint8_t> alpha, std::uint32_t width, std::uint32_t height) {
  CutOutMask mask{std::min(width, kMostMaskEdge), std::min(height, kMostMaskEdge), {}};
  for (std::uint64_t y = 0; y < mask.height; ++y) {
    for (std::uint64_t x = 0; x < mask.width; ++x) {
      std::uint64_t sum = 0;
      std::uint64_t count = 0;
      for (std::uint64_t row = y * height / mask.height; row < (y + 1) * height / mask.height; ++row) {
        for (std::uint64_t column = x * width / mask.width; column < (x + 1) * width / mask.width; ++column) {
          sum += alpha[static_cast<std::size_t>(row * width + column)];
          ++count;
        }
      }
      mask.there.push_back(sum >= 128 * count);
    }
  }
  return mask;
}

std::optional<std::vector<CutOutPart>> cut_out(const CutOutMask& mask, const std::array<Point, 3>& points) {
  std::array<Point, 3> corners{};
  for (std::size_t i = 0; i < 3; ++i) corners[i] = {points[i][0] * mask.width, points[i][1] * mask.height};
  const auto extent = [&corners](std::size_t axis) {
    const auto [least, most] = std::minmax({corners[0][axis], corners[1][axis], corners[2][axis]});
    return most - least + 1;
  };
  constexpr double farthest = 1e12;  // cells are counted in integers
  const bool near = std::ranges::all_of(
      corners, [](const Point& p) { return std::abs(p[0]) <= farthest && std::abs(p[1]) <= farthest; });
  if (!near || !(extent(0) * extent(1) <= kMostMaskCells)) throw std::length_error("too many cells");
  const Cells cells(mask, corners);
  if (cells.all()) return std::nullopt;
  const double area = turn(corners[0], corners[1], corners[2]);
  std::vector<CutOutPart> parts;
  // Without an area among the texture points the triangle shows one cell, or a line of them: the first corner's.
  if (std::abs(area) < 1e-9) {
    const bool there = cells.there(static_cast<std::int64_t>(std::floor(corners[0][0])),
                                   static_cast<std::int64_t>(std::floor(corners[0][1])));
    return there ? std::nullopt : std::optional(parts);
  }
  std::array<Point, 3> around = corners;
  if (area < 0) std::swap(around[1], around[2]);
  const auto weights = [&](const Point& p) -> CutOutCorner {
    return {turn(corners[1], corners[2], p) / area, turn(corners[2], corners[0], p) / area,
            turn(corners[0], corners[1], p) / area};
  };
  for (const Rectangle& one : cells.rectangles()) {
    const auto [low_x, low_y, high_x, high_y] =
        std::array{static_cast<double>(one.low_x), static_cast<double>(one.low_y), static_cast<double>(one.high_x),
                   static_cast<double>(one.high_y)};
    std::vector<Point> part{{low_x, low_y}, {high_x, low_y}, {high_x, high_y}, {low_x, high_y}};
    for (std::size_t i = 0; i < 3; ++i) part = left_of(part, around[i], around[(i + 1) % 3]);
    for (std::size_t i = 2; i < part.size(); ++i) {
      if (turn(part[0], part[i - 1], part[i]) < 1e-9 * std::abs(area)) continue;
      const std::size_t second = area < 0 ? i : i - 1;
      parts.push_back({weights(part[0]), weights(part[second]), weights(part[second == i ? i - 1 : i])});
    }
  }
  return parts;
}

}  // namespace torolux
