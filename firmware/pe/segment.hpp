// SPDX-License-Identifier: MIT
// A path segment: a ray from where light left the eye, an emitter or a specular surface, and how far its walk has come.
#pragma once

#include <cstdint>

#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/records.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

struct Segment {
  glm::vec3 origin;
  glm::vec3 direction;       ///< unit length
  protocol::CellCode place;  ///< the subspace that it enters next
  std::uint32_t polygon;     ///< global number of the polygon that it left, or kNoPolygon
  bool first;                ///< still in the subspace where it began
  std::uint8_t entry_axis;   ///< where not first: 0..2, of the face through which it enters `place`
};

/// The walk's state from a record of either stage.
template <class Record>
Segment segment_of(const Record& record) {
  return {to_vector(record.origin),
          to_vector(record.direction),
          record.place,
          record.polygon,
          (record.flags & protocol::kFirst) != 0,
          static_cast<std::uint8_t>((record.flags & protocol::kEntryAxisMask) >> protocol::kEntryAxisShift)};
}

/// Writes the walk's state back before the record is handed on. Origin and direction never change on the way.
template <class Record>
void note_progress(Record& record, const Segment& segment) {
  record.place = segment.place;
  const std::uint32_t others = record.flags & ~(std::uint32_t{protocol::kFirst} | protocol::kEntryAxisMask);
  record.flags = static_cast<std::uint8_t>(others | (segment.first ? protocol::kFirst : 0U) |
                                           (std::uint32_t{segment.entry_axis} << protocol::kEntryAxisShift));
}

/// Begins the next segment in the subspace where the last one met `polygon` (global number).
template <class Record>
void turn(Record& record, const glm::vec3& origin, const glm::vec3& direction, std::uint32_t polygon) {
  record.origin = to_array(origin);
  record.direction = to_array(direction);
  record.polygon = polygon;
  record.kind = protocol::RecordKind::light;
  record.flags =
      static_cast<std::uint8_t>((record.flags | protocol::kFirst) & ~std::uint32_t{protocol::kEntryAxisMask});
}

}  // namespace torolux::pe
