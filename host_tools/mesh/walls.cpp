// SPDX-License-Identifier: MIT
// A sort along x finds the pairs of triangles that are near; what stands on one, or lies close over it, leaves segments
// in its plane. Whether a wall crosses, touches or parts is asked of these.
#include "host_tools/mesh/walls.hpp"

#include <algorithm>
#include <optional>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Over the triangle, in the object space's longest edge: what stands on it is cut at this height,
constexpr double kFoot = 1e-5;
/// and what lies below this one hides it as if it stood on it. Edges of a Cornell box's lamp, for one.
constexpr double kClose = 1e-3;
/// A way ends so far behind the point where it leads, of its length, so that a wall there counts.
constexpr double kBehind = 0.05;

/// With so many, a triangle's walls are looked up by where they are.
constexpr std::size_t kManyWalls = 16;

using Corners = std::array<Vec3d, 3>;

/// A triangle's plane with its weights as coordinates.
class Plane {
 public:
  explicit Plane(const Corners& corner)
      : origin_(corner[0]),
        across_(vec::subtract(corner[1], corner[0])),
        up_(vec::subtract(corner[2], corner[0])),
        normal_(vec::unit(vec::cross(across_, up_))),
        aa_(vec::dot(across_, across_)),
        ab_(vec::dot(across_, up_)),
        bb_(vec::dot(up_, up_)) {}

  double height(const Vec3d& point) const { return vec::dot(vec::subtract(point, origin_), normal_); }
  PlanePoint below(const Vec3d& point) const {
    const Vec3d way = vec::subtract(point, origin_);
    const double a = vec::dot(way, across_);
    const double b = vec::dot(way, up_);
    const double scale = 1 / (aa_ * bb_ - ab_ * ab_);
    return {(a * bb_ - b * ab_) * scale, (b * aa_ - a * ab_) * scale};
  }

 private:
  Vec3d origin_, across_, up_, normal_;
  double aa_, ab_, bb_;
};

/// Of the segment the part that the half-plane value(from) + t (value(to) - value(from)) >= 0 leaves. False: none.
bool clip(double from, double to, double& begin, double& end) {
  if (from < 0 && to < 0) return false;
  const double t = from / (from - to);
  if (from < 0) begin = std::max(begin, t);
  if (to < 0) end = std::min(end, t);
  return begin <= end;
}

bool passes_through(const WallSegment& wall, const std::array<PlanePoint, 3>& corner) {
  double begin = 0;
  double end = 1;
  for (std::size_t e = 0; e < 3; ++e) {
    const PlanePoint& a = corner[e];
    const PlanePoint& b = corner[(e + 1) % 3];
    const auto side = [&](const PlanePoint& p) {
      return (b.b1 - a.b1) * (p.b2 - a.b2) - (b.b2 - a.b2) * (p.b1 - a.b1);
    };
    const double turn = side(corner[(e + 2) % 3]) > 0 ? 1 : -1;  // children of a grid may be wound either way
    if (!clip(turn * side(wall.from), turn * side(wall.to), begin, end)) return false;
  }
  return true;
}

bool meet(const WallSegment& wall, const PlanePoint& from, const PlanePoint& to) {
  const auto turn = [](const PlanePoint& a, const PlanePoint& b, const PlanePoint& p) {
    return (b.b1 - a.b1) * (p.b2 - a.b2) - (b.b2 - a.b2) * (p.b1 - a.b1);
  };
  return turn(wall.from, wall.to, from) * turn(wall.from, wall.to, to) <= 0 &&
         turn(from, to, wall.from) * turn(from, to, wall.to) <= 0;
}

/// True where the segment misses the triangle for certain.
bool misses(const WallSegment& wall) {
  const auto outside = [&](const auto& weight) { return weight(wall.from) < 0 && weight(wall.to) < 0; };
  return outside([](const PlanePoint& p) { return p.b1; }) || outside([](const PlanePoint& p) { return p.b2; }) ||
         outside([](const PlanePoint& p) { return 1 - p.b1 - p.b2; });
}

/// Where `other` stands on the plane or lies close over it, seen from the side on which heights times `up` are
/// positive.
void add_walls(const Plane& plane, double up, const Corners& other, std::vector<WallSegment>& walls) {
  std::array<double, 3> height{};
  for (std::size_t i = 0; i < 3; ++i) height[i] = up * plane.height(other[i]);
  std::vector<PlanePoint> foot;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t j = (i + 1) % 3;
    if ((height[i] > kFoot) != (height[j] > kFoot)) {
      const double t = (kFoot - height[i]) / (height[j] - height[i]);
      foot.push_back(plane.below(vec::add(other[i], vec::scale(vec::subtract(other[j], other[i]), t))));
    }
    if (height[i] > kFoot && height[j] > kFoot && height[i] < kClose && height[j] < kClose) {
      const WallSegment edge{plane.below(other[i]), plane.below(other[j])};
      if (!misses(edge)) walls.push_back(edge);
    }
  }
  if (foot.size() == 2 && !misses({foot[0], foot[1]})) walls.push_back({foot[0], foot[1]});
}

struct Boxed {
  std::uint32_t triangle;
  vec::Box box;
};

std::vector<Boxed> boxes_of(const Mesh& mesh, std::vector<Corners>& corners) {
  std::vector<Boxed> boxes;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    Boxed boxed{t, {}};
    Corners& corner = corners.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      corner[i] = to_double(mesh.triangles[t].corner[i]);
      boxed.box.include(corner[i]);
    }
    boxes.push_back(boxed);
  }
  std::sort(boxes.begin(), boxes.end(), [](const Boxed& a, const Boxed& b) {
    return a.box.low[0] != b.box.low[0] ? a.box.low[0] < b.box.low[0] : a.triangle < b.triangle;
  });
  return boxes;
}

bool near(const vec::Box& a, const vec::Box& b) {
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (a.low[axis] > b.high[axis] + kClose || b.low[axis] > a.high[axis] + kClose) return false;
  }
  return true;
}

}  // namespace

Walls::Walls(const Mesh& mesh, const std::vector<bool>& wanted) : of_side_(mesh.triangles.size()) {
  std::vector<Corners> corners;
  const std::vector<Boxed> boxes = boxes_of(mesh, corners);
  const auto stand_on = [&](std::uint32_t triangle, std::uint32_t other) {
    if (!wanted[triangle]) return;
    const Plane plane(corners[triangle]);
    for (std::uint32_t side = 0; side < 2; ++side) {
      if ((mesh.triangles[triangle].sides & (1U << side)) == 0) continue;
      add_walls(plane, side == 0 ? 1 : -1, corners[other], of_side_[triangle][side]);
    }
  };
  const auto close = [&](std::size_t i, std::size_t j) { return boxes[j].box.low[0] <= boxes[i].box.high[0] + kClose; };
  const auto look_at = [&](std::size_t i, std::size_t j) {
    if (!near(boxes[i].box, boxes[j].box)) return;
    stand_on(boxes[i].triangle, boxes[j].triangle);
    stand_on(boxes[j].triangle, boxes[i].triangle);
  };
  // Of two neither of which is wanted nothing is asked: a fine mesh has a million of them, side by side.
  std::vector<std::size_t> asked;
  for (std::size_t i = 0; i < boxes.size(); ++i)
    if (wanted[boxes[i].triangle]) asked.push_back(i);
  std::size_t next = 0;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    while (next < asked.size() && asked[next] <= i) ++next;
    if (wanted[boxes[i].triangle]) {
      for (std::size_t j = i + 1; j < boxes.size() && close(i, j); ++j) look_at(i, j);
    } else {
      for (std::size_t k = next; k < asked.size() && close(i, asked[k]); ++k) look_at(i, asked[k]);
    }
  }
  for (std::uint32_t t = 0; t < of_side_.size(); ++t) index(t);
}

void Walls::index(std::uint32_t triangle) {
  const auto& [front, back] = of_side_[triangle];
  if (front.size() + back.size() >= kManyWalls) index_.emplace(triangle, WallIndex({front, back}));
}

bool Walls::pass_inside(std::uint32_t triangle, std::uint32_t code, double inside) const {
  if (of_side_.empty() || (of_side_[triangle][0].empty() && of_side_[triangle][1].empty())) return false;
  const protocol::GridTriangle grid = protocol::grid_triangle_of(code);
  constexpr double unit = 1.0 / (1U << protocol::kMostLevels);
  std::array<PlanePoint, 3> corner{};
  PlanePoint centre;
  for (std::size_t c = 0; c < 3; ++c) {
    corner[c] = {unit * grid.corner[c][1], unit * grid.corner[c][2]};
    centre = {centre.b1 + corner[c].b1 / 3, centre.b2 + corner[c].b2 / 3};
  }
  for (PlanePoint& c : corner) {
    c = {c.b1 + (centre.b1 - c.b1) * inside, c.b2 + (centre.b2 - c.b2) * inside};
  }
  const auto passes = [&](const WallSegment& wall) { return passes_through(wall, corner); };
  if (const auto many = index_.find(triangle); many != index_.end()) return many->second.any_near(corner, passes);
  return std::any_of(of_side_[triangle][0].begin(), of_side_[triangle][0].end(), passes) ||
         std::any_of(of_side_[triangle][1].begin(), of_side_[triangle][1].end(), passes);
}

bool Walls::between(std::uint32_t triangle, std::uint32_t side, const PlanePoint& from, const PlanePoint& to) const {
  if (of_side_.empty()) return false;
  const PlanePoint behind{to.b1 + (to.b1 - from.b1) * kBehind, to.b2 + (to.b2 - from.b2) * kBehind};
  const auto& walls = of_side_[triangle][side];
  return std::any_of(walls.begin(), walls.end(), [&](const WallSegment& wall) { return meet(wall, from, behind); });
}

bool Walls::part(std::uint32_t triangle, const PlanePoint& a, const PlanePoint& b) const {
  if (of_side_.empty()) return false;
  return std::ranges::any_of(of_side_[triangle], [&](const std::vector<WallSegment>& walls) {
    return std::ranges::any_of(walls, [&](const WallSegment& wall) { return meet(wall, a, b); });
  });
}

}  // namespace torolux
