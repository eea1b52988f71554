// SPDX-License-Identifier: MIT
// Radiosity records: the flux of one hemi-cube pixel on its way. Enters: a record that arrived or was just created;
// leaves: flux in an element, a record for another PE, or a sum in the tally.
#include "firmware/pe/final_gather.hpp"
#include "firmware/pe/glossy.hpp"
#include "firmware/pe/landing.hpp"
#include "firmware/pe/specular.hpp"
#include "firmware/pe/surface.hpp"
#include "firmware/protocol/flux.hpp"
#include "firmware/protocol/random.hpp"
#include "firmware/protocol/triangle_grid.hpp"

namespace torolux::pe {
namespace {

using protocol::Fraction;
using protocol::Material;
using protocol::MaterialKind;
using protocol::RadiosityRecord;
using protocol::RecordKind;

/// What a surface lets go on; the rest is absorbed there.
void attenuate(Pe& pe, RadiosityRecord& record, const std::array<Fraction, 3>& fraction) {
  for (std::size_t c = 0; c < 3; ++c) {
    const std::int64_t kept = protocol::scale_down(record.flux[c], fraction[c]);
    pe.tally.absorbed_specular[c] += record.flux[c] - kept;
    record.flux[c] = kept;
  }
}

/// part: 0 and up; above 1 by rounding alone.
Fraction fraction_of(float part) {
  return part < 1.0F ? Fraction{static_cast<std::uint32_t>(part * 0x1p32F)} : protocol::kOne;
}

/// Of a pane's two ways one by chance, with what of the light goes that way. True: it passes, unbent, and is an
/// emitter's own light still, as shadow rays pass likewise.
bool passes_pane(Pe& pe, RadiosityRecord& record, const Material& material, const glm::vec3& geometric) {
  const PaneParts parts =
      pane_parts(to_vector(record.direction), geometric, material.refractive_index, to_vector(material.transmittance));
  const bool passes = !(protocol::uniform(record.key, protocol::Dimension::fresnel) < parts.reflectance);
  const glm::vec3 kept = passes ? parts.passed / (1.0F - parts.reflectance) : parts.reflected / parts.reflectance;
  attenuate(pe, record, {fraction_of(kept.x), fraction_of(kept.y), fraction_of(kept.z)});
  return passes;
}

/// Turns the record's light at mirror, glass or pane; of glass's two ways one is taken by chance. False: it has ended.
bool turn_light(Pe& pe, Niu& niu, Slot slot, const Hit& hit) {
  const PhaseMark<Phase::shade> mark(niu);
  auto& record = pe.slots.at<RadiosityRecord>(slot);
  ++record.bounce;
  if (record.bounce >= pe.scene.layout.bounces) {
    add_flux(pe.tally.cut_off, record.flux);
    end_record(pe, niu, slot);
    return false;
  }
  const protocol::Polygon& polygon = pe.scene.polygons[hit.polygon];
  const Material& material = pe.scene.materials[polygon.material];
  const glm::vec3 in = to_vector(record.direction);
  const glm::vec3 origin = leaving_point(polygon, to_vector(record.origin) + in * hit.t);
  const glm::vec3 geometric = unit_normal(polygon);
  const glm::vec3 shading = shading_normal(pe.scene, polygon, hit);
  record.key = protocol::hash_combine(record.key, record.bounce);
  glm::vec3 out{};
  bool passes = false;
  if (material.kind == MaterialKind::mirror) {
    attenuate(pe, record, material.specular_fraction);
    out = reflect(in, geometric, shading);
  } else if (material.kind == MaterialKind::pane) {
    passes = passes_pane(pe, record, material, geometric);
    out = passes ? in : reflect(in, geometric, geometric);
  } else {
    const float eta = hit.front ? 1.0F / material.refractive_index : material.refractive_index;
    const Refraction way = refract(in, geometric, shading, eta);
    if (protocol::uniform(record.key, protocol::Dimension::fresnel) < way.reflectance) {
      out = reflect(in, geometric, shading);
    } else {
      attenuate(pe, record, material.transmittance_fraction);
      out = way.direction;
    }
  }
  turn(record, origin, out, polygon.number);
  if (!passes)
    record.flags = static_cast<std::uint8_t>((record.flags & ~std::uint32_t{protocol::kDirect}) | protocol::kTurned);
  if (record.flux[0] == 0 && record.flux[1] == 0 && record.flux[2] == 0) {
    end_record(pe, niu, slot);
    return false;
  }
  return true;
}

/// Glossy: whether the light goes on by the lobe when its element has got it. If so, the record takes the way with it:
/// all of its flux falls on the element, so nothing is chosen by chance about that.
void choose_lobe(const Pe& pe, RadiosityRecord& record, const Hit& hit) {
  const protocol::Polygon& polygon = pe.scene.polygons[hit.polygon];
  const Material& material = pe.scene.materials[polygon.material];
  const std::uint32_t key = protocol::hash_combine(record.key, record.bounce + 1U);
  const glm::vec3 in = to_vector(record.direction);
  const LobeSample way = sample_lobe(material, in, unit_normal(polygon), shading_normal(pe.scene, polygon, hit),
                                     protocol::uniform(key, protocol::Dimension::lobe_height),
                                     protocol::uniform(key, protocol::Dimension::lobe_turn));
  if (!(protocol::uniform(key, protocol::Dimension::lobe) < way.cosine * material.lobe_chance)) return;
  record.origin = to_array(leaving_point(polygon, to_vector(record.origin) + in * hit.t));
  record.direction = to_array(way.direction);
  record.key = polygon.number;
  record.flags |= protocol::kGoesOn;
}

void check_record(const Pe& pe, Niu& niu, const RadiosityRecord& record) {
  check_flux(niu, record.flux);
  if (record.kind == RecordKind::deposit) {
    check_landing(pe, niu, record.place, (record.flags & protocol::kBackSide) != 0 ? 1U : 0U);
    return;
  }
  require(niu, record.kind == RecordKind::light, RecordField::kind, static_cast<std::uint32_t>(record.kind));
  check_walk(pe, niu, record);
}

}  // namespace

void handle_radiosity_record(Pe& pe, Niu& niu, Slot slot) {
  check_slot(pe, niu, slot);
  const auto& record = pe.slots.at<RadiosityRecord>(slot);
  if (record.kind == RecordKind::point) {
    const auto& point = pe.slots.at<protocol::PointRecord>(slot);
    check_flux(niu, point.flux);
    require(niu, inside_grid(pe.scene.layout, point.place), RecordField::place, point.place);
    take_point(pe, niu, point);
    niu.release(slot);
    return;
  }
  if (record.kind == RecordKind::gather_point) {
    const auto& point = pe.slots.at<protocol::GatherPointRecord>(slot);
    check_gather_point(pe, niu, point);
    take_point(pe, niu, std::bit_cast<protocol::PointRecord>(point));
    niu.release(slot);
    return;
  }
  if (protocol::is_of_gathering(record.kind)) {
    handle_gather_record(pe, niu, slot);
    return;
  }
  check_record(pe, niu, record);
  if (record.kind != RecordKind::deposit) {
    follow_light(pe, niu, slot);
    return;
  }
  const PhaseMark<Phase::deposit> mark(niu);
  const protocol::PatchPart& part = pe.scene.patch_parts[record.place];
  const std::uint32_t element = protocol::leaf_on_way(pe.scene.nodes.data(), part.tree, record.polygon);
  add_to_element(pe, part.patch, element, (record.flags & protocol::kBackSide) != 0 ? 1 : 0,
                 (record.flags & pe.scene.layout.apart) != 0, record.flux);
  if (leave_element(pe, niu, slot, part.patch)) follow_light(pe, niu, slot);
}

bool leave_element(Pe& pe, Niu& niu, Slot slot, std::uint32_t patch) {
  auto& record = pe.slots.at<RadiosityRecord>(slot);
  if ((record.flags & protocol::kGoesOn) == 0) {
    end_record(pe, niu, slot);
    return false;
  }
  const protocol::Patch& from = pe.scene.patches[patch];
  const Material& material = pe.scene.materials[pe.scene.polygons[pe.scene.facets[from.first_facet].polygon].material];
  std::int64_t any = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    record.flux[c] = protocol::scale_by(record.flux[c], material.specular_fraction[c]);
    any |= record.flux[c];
  }
  add_flux(pe.tally.reflected_glossy, record.flux);
  ++record.bounce;
  const bool cut_off = record.bounce >= pe.scene.layout.bounces;
  if (cut_off) add_flux(pe.tally.cut_off, record.flux);
  if (cut_off || any == 0) {
    end_record(pe, niu, slot);
    return false;
  }
  record.place = cell_of(pe.scene.layout, to_vector(record.origin));
  record.polygon = record.key;
  // The way was chosen by the record's key, whose place the polygon took: so it makes as good a key itself.
  record.key = pe.scene.layout.seed;
  for (const float x : record.direction) {
    record.key = protocol::hash_combine(record.key, std::bit_cast<std::uint32_t>(x));
  }
  record.kind = RecordKind::light;
  record.flags = protocol::kFirst | protocol::kTurned;
  return true;
}

void follow_light(Pe& pe, Niu& niu, Slot slot) {
  auto& record = pe.slots.at<RadiosityRecord>(slot);
  for (;;) {
    const Way way = traverse_record(pe, niu, record);
    if (way.end == WayEnd::handed_on) {
      pe.outbox.put(niu, pe.slots, way.next, slot);
      return;
    }
    if (way.end == WayEnd::escaped) {
      add_flux(pe.tally.escaped, record.flux);
      end_record(pe, niu, slot);
      return;
    }
    const MaterialKind kind = pe.scene.materials[pe.scene.polygons[way.hit.polygon].material].kind;
    if (kind == MaterialKind::glossy) choose_lobe(pe, record, way.hit);
    if (!(is_specular(kind) ? turn_light(pe, niu, slot, way.hit) : deposit(pe, niu, slot, way.hit))) return;
  }
}

}  // namespace torolux::pe
