// SPDX-License-Identifier: MIT
// The walk from subspace to subspace, and the first hit in each. Where a PE spends most of its time.
#include "firmware/pe/traverse.hpp"

#include <limits>

#include "firmware/pe/intersect.hpp"
#include "firmware/pe/surface.hpp"
#include "firmware/pe/walk.hpp"

namespace torolux::pe {
namespace {

using protocol::kNobody;
using protocol::PeNumber;
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
  if (!segment.first || !(crossing.t > -reach) || !(crossing.sum > 0.0F)) return false;
  const float slope = glm::dot(segment.direction, unit_normal(polygon));
  return slope < 0.0F && crossing.t * slope <= depth;
}

void find_nearest(const Scene& scene, const Subspace& here, const Segment& segment, const Walk& walk,
                  const Shear& shear, Reach& reach, Nearest& nearest) {
  const float t_in = segment.first || bits(walk.t_in()) < 0 ? 0.0F : walk.t_in();
  // The outer faces of the object space end no interval: walls often lie in them, and rounding puts their hits on
  // either side.
  const bool open_begin = segment.first || here.neighbour_pe[walk.entry_face(segment.entry_axis)] == kNobody;
  const bool last = here.neighbour_pe[walk.exit_face()] == kNobody;
  const float t_out = last ? std::numeric_limits<float>::infinity() : walk.t_out();
  const std::uint32_t box = reach.box(here.cell, t_in, walk.t_out());
  const auto test = [&](const protocol::ListedPolygon& listed) {
    const Polygon& polygon = scene.polygons[listed.polygon];
    if (polygon.number == segment.polygon) return;
    Crossing crossing;
    if (!cross_triangle(shear, polygon, crossing)) return;
    const bool counts = crossing.t > 0.0F ? crossing.t <= t_out && (open_begin || crossing.t > t_in)
                                          : counts_behind_origin(segment, polygon, crossing);
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

Hit hit_of(const Nearest& nearest) {
  const float inverse = 1.0F / nearest.crossing.sum;
  return {nearest.t, nearest.crossing.v * inverse, nearest.crossing.w * inverse, nearest.polygon,
          nearest.crossing.sum > 0.0F};
}

/// Walks to the subspace that holds the origin. False: it is another PE's (`next`), segment.subspace its number there.
bool seek(const Scene& scene, PeNumber self, Segment& segment, PeNumber& next) {
  for (;;) {
    const Subspace& here = scene.subspaces[segment.subspace];
    const std::uint32_t face = seek_face(scene.layout, segment.origin, here.cell);
    if (face == protocol::kFaces || here.neighbour_pe[face] == kNobody) {
      segment.seeking = false;
      segment.first = true;
      return true;
    }
    segment.subspace = here.neighbour[face];
    next = here.neighbour_pe[face];
    if (next != self) return false;
  }
}

/// Goes through the exit face. False: the next subspace is not here, and `way` says why.
inline bool step(const Scene& scene, PeNumber self, Segment& segment, Walk& walk, const Subspace*& here, Way& way) {
  const std::uint32_t face = walk.exit_face();
  way.next = here->neighbour_pe[face];
  if (way.next == kNobody) {
    way.end = WayEnd::escaped;
    return false;
  }
  segment.subspace = here->neighbour[face];
  segment.first = false;
  segment.entry_axis = static_cast<std::uint8_t>(walk.exit_axis());
  if (way.next != self) {
    way.end = WayEnd::handed_on;
    return false;
  }
  here = &scene.subspaces[segment.subspace];
  ++way.visited;
  walk.cross(*here);
  return true;
}

}  // namespace

Way traverse(const Scene& scene, PeNumber self, Segment& segment) {
  Way way{};
  if (segment.seeking && !seek(scene, self, segment, way.next)) {
    way.end = WayEnd::handed_on;
    return way;
  }
  const Subspace* here = &scene.subspaces[segment.subspace];
  way.visited = 1;
  Walk walk(scene.layout, segment, *here);
  // Most subspaces hold no polygon: what only those need of the ray waits until one does.
  while (here->polygon_count == 0) {
    if (!step(scene, self, segment, walk, here, way)) return way;
  }
  const Shear shear(segment.origin, segment.direction, walk.inverse());
  Reach reach(segment.origin, segment.direction, walk.inverse(), scene.box_scale);
  do {
    if (here->polygon_count == 0) continue;
    Nearest nearest;
    find_nearest(scene, *here, segment, walk, shear, reach, nearest);
    if (nearest.polygon != protocol::kNoPolygon) {
      way.end = WayEnd::hit;
      way.hit = hit_of(nearest);
      return way;
    }
  } while (step(scene, self, segment, walk, here, way));
  return way;
}

}  // namespace torolux::pe
