// SPDX-License-Identifier: MIT
// The walk from subspace to subspace, and the first hit in each. Where a PE spends most of its time.
#include "firmware/pe/traverse.hpp"

#include <limits>

#include "firmware/pe/intersect.hpp"
#include "firmware/pe/surface.hpp"
#include "firmware/pe/walk.hpp"

namespace torolux::pe {
namespace {

using protocol::Polygon;
using protocol::Subspace;

/// The nearest crossing so far; of equal distances the polygon with the lowest global number.
struct Nearest {
  Crossing crossing;
  float t = std::numeric_limits<float>::infinity();
  std::uint32_t polygon = protocol::kNoPolygon;  ///< index
  std::uint32_t number = protocol::kNoPolygon;   ///< global
};

/// A segment's origin is rounded, so it may lie a little behind a wall that it is to meet. Such a hit counts where the
/// segment began, if the wall is met from its front and the origin no deeper behind it than rounding explains.
bool counts_behind_origin(const Segment& segment, const Polygon& polygon, const Crossing& crossing) {
  constexpr float reach = 0x1p-14F;
  constexpr float depth = 0x1p-20F;
  if (!(crossing.t > -reach) || !(crossing.sum > 0.0F)) return false;
  const float slope = glm::dot(segment.direction, unit_normal(polygon));
  return slope < 0.0F && crossing.t * slope <= depth;
}

void find_nearest(const Scene& scene, const Subspace& here, const Segment& segment, const Walk& walk,
                  const Shear& shear, Reach& reach, Nearest& nearest) {
  const float t_in = walk.first() || bits(walk.t_in()) < 0 ? 0.0F : walk.t_in();
  // The outer faces of the object space end no interval: walls often lie in them, and rounding puts their hits on
  // either side.
  const bool open_begin = walk.first() || walk.came_from_outside();
  const float t_out = walk.goes_outside() ? std::numeric_limits<float>::infinity() : walk.t_out();
  const std::uint32_t box = reach.box(walk, t_in, walk.t_out());
  const auto test = [&](const protocol::ListedPolygon& listed) {
    const Polygon& polygon = scene.polygons[listed.polygon];
    if (polygon.number == segment.polygon) return;
    Crossing crossing;
    if (!cross_triangle(shear, polygon, crossing)) return;
    const bool counts = crossing.t > 0.0F ? crossing.t <= t_out && (open_begin || crossing.t > t_in)
                                          : walk.first() && counts_behind_origin(segment, polygon, crossing);
    if (counts && (crossing.t < nearest.t || (crossing.t == nearest.t && polygon.number < nearest.number))) {
      nearest.crossing = crossing;
      nearest.t = crossing.t;
      nearest.polygon = listed.polygon;
      nearest.number = polygon.number;
    }
  };
  const protocol::ListedPolygon* entry = scene.polygon_list.data() + here.first_polygon;
  const protocol::ListedPolygon* const end = entry + here.polygon_count;
  while (entry != end) {
    const protocol::ListedPolygon* group_end = end;
    if ((entry->polygon & protocol::kGroup) != 0) {
      const bool apart = protocol::boxes_apart(box, entry->box);
      group_end = entry + 1 + (entry->polygon & ~protocol::kGroup);
      entry = apart ? group_end : entry + 1;
    }
    for (; entry != group_end; ++entry) {
      if (!protocol::boxes_apart(box, entry->box)) test(*entry);
    }
  }
}

/// From a cell at which it stops: the subspace there, or the next one that holds anything. nullptr where the way ends
/// before, and `way` says how.
inline const Subspace* next_full(const Scene& scene, Walk& walk, Way& way) {
  do {
    const protocol::CellEntry entry = scene.map.entry(walk.index());
    if ((entry & protocol::kHeld) == 0) {
      way.end = WayEnd::handed_on;
      way.next = static_cast<protocol::PeNumber>(entry);
      return nullptr;
    }
    ++way.visited;
    const Subspace& here = scene.subspaces[entry & ~protocol::kHeld];
    if (here.polygon_count != 0) return &here;
  } while (walk.advance(scene.map));
  way.end = WayEnd::escaped;
  return nullptr;
}

/// The first hit in this PE's subspaces, if there is one before the way ends otherwise.
Way look_along(const Scene& scene, const Segment& segment, Walk& walk) {
  Way way{};
  way.end = WayEnd::escaped;
  if (!scene.map.stops(walk.index()) && !walk.advance(scene.map)) return way;
  const Subspace* here = next_full(scene, walk, way);
  if (here == nullptr) return way;
  // Only who looks into a subspace needs this of the ray.
  const Shear shear(segment.origin, segment.direction, walk.inverse());
  Reach reach(segment.origin, segment.direction, walk.inverse(), scene.box_scale);
  do {
    Nearest nearest;
    find_nearest(scene, *here, segment, walk, shear, reach, nearest);
    if (nearest.polygon != protocol::kNoPolygon) {
      way.end = WayEnd::hit;
      way.hit = hit_of(nearest.crossing, nearest.t, nearest.polygon);
      return way;
    }
    if (!walk.advance(scene.map)) {
      way.end = WayEnd::escaped;
      return way;
    }
    here = next_full(scene, walk, way);
  } while (here != nullptr);
  return way;
}

}  // namespace

Way traverse(const Scene& scene, Segment& segment) {
  Walk walk(scene.layout, segment);
  const Way way = look_along(scene, segment, walk);
  segment.place = walk.place();
  segment.first = walk.first();
  segment.entry_axis = walk.entry_axis();
  return way;
}

}  // namespace torolux::pe
