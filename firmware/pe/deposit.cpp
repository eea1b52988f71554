// SPDX-License-Identifier: MIT
// Light that falls on a diffuse or glossy surface. Enters: a record and its hit; leaves: flux in an element, or a
// deposit record on its way to the element's owner.
#include "firmware/pe/landing.hpp"

namespace torolux::pe {
void add_to_element(Pe& pe, std::uint32_t patch, std::uint32_t element, std::uint32_t side, bool apart,
                    const protocol::Flux& flux) {
  protocol::PatchSide& patch_side = pe.scene.patch_sides[pe.scene.patches[patch].side[side]];
  protocol::Element& target = pe.scene.elements[patch_side.first_element + element];
  add_flux(patch_side.incident, flux);
  add_flux(target.flux, flux);
  if (apart) add_flux(target.apart, flux);
}

bool deposit(Pe& pe, Niu& niu, Slot slot, const Hit& hit) {
  const PhaseMark<Phase::deposit> mark(niu);
  auto& record = pe.slots.at<protocol::RadiosityRecord>(slot);
  if (!is_lit(pe.scene, hit)) {
    add_flux(pe.tally.back_side, record.flux);
    end_record(pe, niu, slot);
    return false;
  }
  protocol::Weights at{};
  const protocol::PatchReference& owner = owner_of(pe.scene, hit, at);
  if (owner.pe == niu.pe()) {
    const protocol::PatchPart& part = pe.scene.patch_parts[owner.part];
    const std::uint32_t element = protocol::find_leaf(pe.scene.nodes.data(), part.tree, at);
    add_to_element(pe, part.patch, element, hit.front ? 0 : 1, (record.flags & pe.scene.layout.apart) != 0,
                   record.flux);
    return leave_element(pe, niu, slot, part.patch);
  }
  record.kind = protocol::RecordKind::deposit;
  record.place = owner.part;
  record.polygon = protocol::way_to_leaf(at, owner.levels);
  record.flags =
      static_cast<std::uint8_t>((record.flags & (protocol::kDirect | protocol::kTurned | protocol::kGoesOn)) |
                                (hit.front ? 0U : protocol::kBackSide));
  pe.outbox.put(niu, pe.slots, owner.pe, slot);
  return false;
}

}  // namespace torolux::pe
