// SPDX-License-Identifier: MIT
// Light that falls on a diffuse or glossy surface. Enters: a record and its hit; leaves: flux in an element, or a
// deposit record on its way to the element's owner.
#include "firmware/pe/pe.hpp"
#include "firmware/protocol/triangle_grid.hpp"

namespace torolux::pe {
void add_to_element(Pe& pe, std::uint32_t patch, std::uint32_t element, std::uint32_t side, bool direct,
                    const protocol::Flux& flux) {
  protocol::PatchSide& patch_side = pe.scene.patch_sides[pe.scene.patches[patch].side[side]];
  protocol::Element& target = pe.scene.elements[patch_side.first_element + element];
  add_flux(patch_side.incident, flux);
  add_flux(target.flux, flux);
  if (direct) add_flux(target.direct, flux);
}

bool deposit(Pe& pe, Niu& niu, Slot slot, const Hit& hit) {
  const PhaseMark<Phase::deposit> mark(niu);
  auto& record = pe.slots.at<protocol::RadiosityRecord>(slot);
  const protocol::Polygon& polygon = pe.scene.polygons[hit.polygon];
  const bool lit = (polygon.sides & (hit.front ? protocol::kFrontPresent : protocol::kBackPresent)) != 0;
  if (!lit) {
    add_flux(pe.tally.back_side, record.flux);
    end_record(pe, niu, slot);
    return false;
  }
  protocol::Weights at{(1.0F - hit.b1) - hit.b2, hit.b1, hit.b2};
  const std::uint32_t path = protocol::enter_level(at, polygon.patch_level);
  const protocol::PatchReference& owner = pe.scene.patch_references[polygon.surface + path];
  if (owner.pe == niu.pe()) {
    const protocol::PatchPart& part = pe.scene.patch_parts[owner.part];
    const std::uint32_t element = protocol::find_leaf(pe.scene.nodes.data(), part.tree, at);
    add_to_element(pe, part.patch, element, hit.front ? 0 : 1, (record.flags & protocol::kDirect) != 0, record.flux);
    return leave_element(pe, niu, slot, part.patch);
  }
  record.kind = protocol::RecordKind::deposit;
  record.place = owner.part;
  record.polygon = protocol::way_to_leaf(at, owner.levels);
  record.flags = static_cast<std::uint8_t>((record.flags & (protocol::kDirect | protocol::kGoesOn)) |
                                           (hit.front ? 0U : protocol::kBackSide));
  pe.outbox.put(niu, pe.slots, owner.pe, slot);
  return false;
}

}  // namespace torolux::pe
