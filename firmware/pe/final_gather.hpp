// SPDX-License-Identifier: MIT
// Final gathering (Reichert 1992): when all shots are over, elements look around for what lights them. Enters: points
// of elements; leaves: rays against the light's way, questions to the owners of what they meet, answers.
#pragma once

#include "firmware/pe/pe.hpp"

namespace torolux::pe {

/// The layout asks for it: light that rays against its way would not find is kept apart.
inline bool gathers(const protocol::StageLayout& layout) {
  return (layout.apart & protocol::kTurned) != 0;
}

/// Before the stage: areas of all elements, of their facets.
void note_areas(const Scene& scene);
/// Before a side's first point: its elements have gathered nothing.
void begin_gathering(const Scene& scene, const protocol::Shoot& shoot);
/// Makes a point one of its element, which counts it. Where no record has come to the side, its rays would hardly
/// find light either (it faces outside, mostly): such a point's area is 0, and it makes none.
protocol::GatherPointRecord gathering_point(const Scene& scene, const protocol::Shoot& shoot, std::uint32_t element,
                                            PeNumber home, const protocol::PointRecord& at);

/// The next ray of the point that is being expanded. Takes a credit.
void create_gather_ray(Pe& pe, Niu& niu);

/// A record that has come: gather, question or answer, slot and kind checked.
void handle_gather_record(Pe& pe, Niu& niu, Slot slot);
/// Of a point.
void check_gather_point(const Pe& pe, Niu& niu, const protocol::GatherPointRecord& point);

}  // namespace torolux::pe
