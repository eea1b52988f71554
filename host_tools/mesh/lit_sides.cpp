// SPDX-License-Identifier: MIT
// For each closed component that does not touch itself: emitters outside and inside of it, by winding numbers, say
// which sides are lit. All other triangles keep both.
#include "host_tools/mesh/lit_sides.hpp"

#include <algorithm>
#include <limits>
#include <numbers>

#include "firmware/protocol/stores.hpp"
#include "host_tools/mesh/edges.hpp"
#include "host_tools/mesh/separation.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

using protocol::kBackPresent;
using protocol::kFrontPresent;

/// Corners are rounded to float later on (2^-24): nearer than this may touch.
constexpr double kTouch = 1e-6;
/// An emitter nearer to a component than this counts as on both sides of it.
constexpr double kEmitterTouch = 1e-4;
/// Larger components keep both sides: the search for places where they touch themselves would take too long.
constexpr std::size_t kMostTriangles = 200'000;

struct Box {
  Vec3d low;
  Vec3d high;
};

struct Component {
  std::vector<std::uint32_t> triangles;
  bool closed = true;
};

class Sides {
 public:
  Sides(std::span<const Vec3d> positions, std::span<const SideTriangle> triangles, bool sky)
      : positions_(positions), triangles_(triangles), sky_(sky) {
    boxes_.reserve(triangles.size());
    for (std::uint32_t t = 0; t < triangles.size(); ++t) boxes_.push_back(box_of(corners(t)));
  }

  std::vector<std::uint8_t> find() {
    std::vector<std::uint8_t> sides(triangles_.size(), kFrontPresent | kBackPresent);
    for (const Component& component : components()) {
      if (!component.closed || touches_itself(component)) continue;
      const double volume = volume_of(component);
      if (!(std::abs(volume) > 1e-12)) continue;
      const std::uint8_t outside = volume > 0 ? kFrontPresent : kBackPresent;
      const std::uint8_t lit = lit_sides_of(component, outside);
      for (const std::uint32_t t : component.triangles) sides[t] = lit;
    }
    return sides;
  }

 private:
  std::array<Vec3d, 3> corners(std::uint32_t t) const {
    const auto& p = triangles_[t].position;
    return {positions_[p[0]], positions_[p[1]], positions_[p[2]]};
  }

  static Box box_of(const std::array<Vec3d, 3>& corner) {
    Box box{corner[0], corner[0]};
    for (const Vec3d& point : corner) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], point[axis]);
        box.high[axis] = std::max(box.high[axis], point[axis]);
      }
    }
    return box;
  }

  static bool near(const Box& a, const Box& b, double gap) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (a.low[axis] > b.high[axis] + gap || b.low[axis] > a.high[axis] + gap) return false;
    }
    return true;
  }

  std::vector<Component> components() const {
    std::vector<std::array<std::uint32_t, 3>> triangles;
    triangles.reserve(triangles_.size());
    for (const SideTriangle& triangle : triangles_) triangles.push_back(triangle.position);
    const std::vector<EdgeUse> uses = edge_uses(triangles);
    DisjointSets sets(triangles_.size());
    std::vector<bool> open(triangles_.size(), false);
    for_each_edge(uses, [&](std::span<const EdgeUse> edge) {
      const bool shared_by_two = edge.size() == 2 && edge[0].forward != edge[1].forward;
      for (const EdgeUse& use : edge) {
        sets.merge(edge[0].triangle, use.triangle);
        if (!shared_by_two) open[use.triangle] = true;
      }
    });
    std::vector<Component> by_root(triangles_.size());
    for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
      Component& component = by_root[sets.root(t)];
      component.triangles.push_back(t);
      if (open[t] || !triangles_[t].opaque) component.closed = false;
    }
    std::erase_if(by_root, [](const Component& component) { return component.triangles.empty(); });
    return by_root;
  }

  bool pair_touches(std::uint32_t a, std::uint32_t b) const {
    const auto& pa = triangles_[a].position;
    const auto& pb = triangles_[b].position;
    const auto corners_a = corners(a);
    const auto corners_b = corners(b);
    std::size_t shared_a = 3;
    std::size_t shared_b = 3;
    int shared = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < 3; ++j) {
        if (pa[i] != pb[j]) continue;
        ++shared;
        shared_a = i;
        shared_b = j;
      }
    }
    if (shared >= 2) return false;  // folded flat at worst, which encloses nothing
    if (shared == 0) return !apart(corners_a, corners_b, kTouch);
    const std::array<Vec3d, 2> opposite_a{corners_a[(shared_a + 1) % 3], corners_a[(shared_a + 2) % 3]};
    const std::array<Vec3d, 2> opposite_b{corners_b[(shared_b + 1) % 3], corners_b[(shared_b + 2) % 3]};
    return !apart(opposite_a, corners_b, kTouch) || !apart(opposite_b, corners_a, kTouch);
  }

  bool touches_itself(const Component& component) const {
    if (component.triangles.size() > kMostTriangles) return true;
    std::vector<std::uint32_t> order = component.triangles;
    std::sort(order.begin(), order.end(), [this](std::uint32_t a, std::uint32_t b) {
      return boxes_[a].low[0] != boxes_[b].low[0] ? boxes_[a].low[0] < boxes_[b].low[0] : a < b;
    });
    for (std::size_t i = 0; i < order.size(); ++i) {
      const Box& box = boxes_[order[i]];
      for (std::size_t j = i + 1; j < order.size() && boxes_[order[j]].low[0] <= box.high[0] + kTouch; ++j) {
        if (near(box, boxes_[order[j]], kTouch) && pair_touches(order[i], order[j])) return true;
      }
    }
    return false;
  }

  double volume_of(const Component& component) const {
    double six = 0;
    for (const std::uint32_t t : component.triangles) {
      const auto c = corners(t);
      six += vec::dot(c[0], vec::cross(c[1], c[2]));
    }
    return six / 6;
  }

  /// Whether a point off the surface is inside: winding number by solid angles.
  bool inside(const Component& component, const Vec3d& point) const {
    double angle = 0;
    for (const std::uint32_t t : component.triangles) angle += vec::solid_angle(corners(t), point);
    return std::abs(angle) > 2 * std::numbers::pi;
  }

  std::uint8_t lit_sides_of(const Component& component, std::uint8_t outside) const {
    const auto inner = static_cast<std::uint8_t>(outside ^ (kFrontPresent | kBackPresent));
    std::vector<bool> own(triangles_.size(), false);
    Box box = boxes_[component.triangles.front()];
    for (const std::uint32_t t : component.triangles) {
      own[t] = true;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        box.low[axis] = std::min(box.low[axis], boxes_[t].low[axis]);
        box.high[axis] = std::max(box.high[axis], boxes_[t].high[axis]);
      }
    }
    std::uint8_t lit = sky_ ? outside : std::uint8_t{0};
    for (std::uint32_t t = 0; t < triangles_.size() && lit != (kFrontPresent | kBackPresent); ++t) {
      if (triangles_[t].emits_from == 0) continue;
      if (own[t]) {
        lit |= triangles_[t].emits_from;
      } else if (!near(boxes_[t], box, kEmitterTouch)) {
        lit |= outside;
      } else if (touches(component, t)) {
        lit |= kFrontPresent | kBackPresent;
      } else {
        lit |= inside(component, corners(t)[0]) ? inner : outside;
      }
    }
    return lit;
  }

  bool touches(const Component& component, std::uint32_t emitter) const {
    return std::any_of(component.triangles.begin(), component.triangles.end(), [&](std::uint32_t t) {
      return near(boxes_[t], boxes_[emitter], kEmitterTouch) && !apart(corners(t), corners(emitter), kEmitterTouch);
    });
  }

  std::span<const Vec3d> positions_;
  std::span<const SideTriangle> triangles_;
  bool sky_;
  std::vector<Box> boxes_;
};

}  // namespace

std::vector<std::uint8_t> lit_sides(std::span<const Vec3d> positions, std::span<const SideTriangle> triangles,
                                    bool sky) {
  return Sides(positions, triangles, sky).find();
}

}  // namespace torolux
