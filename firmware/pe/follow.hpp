// SPDX-License-Identifier: MIT
// What records of both stages share: the checks of one that has just arrived, and its way through this PE's subspaces.
#pragma once

#include <algorithm>
#include <cstdint>

#include "firmware/pe/pe.hpp"
#include "firmware/pe/segment.hpp"
#include "firmware/pe/traverse.hpp"
#include "firmware/protocol/fault_fields.hpp"

namespace torolux::pe {

using protocol::RecordField;

inline void require(Niu& niu, bool holds, RecordField field, std::uint32_t value) {
  if (!holds) niu.fail(FaultCode::bad_record, static_cast<std::uint32_t>(field), value);
}

inline void check_slot(const Pe& pe, Niu& niu, Slot slot) {
  require(niu, slot < pe.slots.count() && !pe.slots.is_own(slot), RecordField::slot, slot);
}

inline bool inside_grid(const protocol::StageLayout& layout, protocol::CellCode place) {
  return protocol::cell_along(place, 0) < layout.cells[0] && protocol::cell_along(place, 1) < layout.cells[1] &&
         protocol::cell_along(place, 2) < layout.cells[2];
}

/// Where the walk stands, of a record of kind light.
template <class Record>
void check_walk(const Pe& pe, Niu& niu, const Record& record) {
  require(niu, inside_grid(pe.scene.layout, record.place), RecordField::place, record.place);
  require(niu, (record.flags & protocol::kEntryAxisMask) != protocol::kEntryAxisMask, RecordField::entry_axis,
          record.flags);
}

/// As far as this PE can follow it; the record says where it has come to.
template <class Record>
Way traverse_record(Pe& pe, Niu& niu, Record& record) {
  Segment segment = segment_of(record);
  niu.enter_phase<Phase::traverse>();
  const Way way = traverse(pe.scene, segment);
  niu.leave_phase<Phase::traverse>();
  note_progress(record, segment);
  const std::uint32_t visited = std::min(record.visited + way.visited, protocol::kMostVisits);
  const bool ends = way.end != WayEnd::handed_on;
  record.visited = static_cast<decltype(record.visited)>(ends ? 0 : visited);
  if (ends) ++pe.visits[visited];
  return way;
}

}  // namespace torolux::pe
