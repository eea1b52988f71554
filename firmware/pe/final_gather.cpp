// SPDX-License-Identifier: MIT
// A ray leaves its element by the cosine, so each is worth as much. The owner of the element that it meets answers with
// what that gives off of all light that has come to it; the ray's own element adds it up. By panes rays go straight on;
// at mirrors and glass they end, as what comes from there is kept apart.
#include "firmware/pe/final_gather.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "firmware/pe/follow.hpp"
#include "firmware/pe/landing.hpp"
#include "firmware/pe/specular.hpp"
#include "firmware/pe/surface.hpp"
#include "firmware/protocol/random.hpp"
#include "firmware/protocol/triangle_grid.hpp"

namespace torolux::pe {
namespace {

using protocol::Element;
using protocol::GatherPointRecord;
using protocol::GatherRecord;
using protocol::RadiosityRecord;
using protocol::RecordKind;

/// Of all rays of the element, by their numbers: neighbours' points follow each other, so that together they look as
/// evenly around as each by itself. A square is laid over the disc below the hemisphere, rings onto rings (Shirley &
/// Chiu 1997; Malley's method).
glm::vec3 cosine_direction(const Frame& frame, const protocol::StratifiedPair& at) {
  const float a = 2.0F * protocol::uniform_float(at.x) - 1.0F;
  const float b = 2.0F * protocol::uniform_float(at.y) - 1.0F;
  const bool wide = std::fabs(a) > std::fabs(b);
  const float r = wide ? a : b;
  const float along = wide ? b : a;
  constexpr float kEighth = 0.785398163F;  // of a turn
  const SineCosine by = sine_cosine(r != 0.0F ? kEighth * (along / r) : 0.0F);
  const float x = r * (wide ? by.cosine : by.sine);
  const float y = r * (wide ? by.sine : by.cosine);
  const float z = std::sqrt(std::max(1.0F - r * r, 0.0F));
  return (frame.x * x + frame.y * y) + frame.z * z;
}

/// Light that is not finite may wrap round: added without sign.
void add_to_gathered(Pe& pe, std::uint32_t element, const protocol::Flux& flux) {
  protocol::Flux& sum = pe.scene.elements[element].gathered;
  for (std::size_t c = 0; c < 3; ++c)
    sum[c] = static_cast<std::int64_t>(static_cast<std::uint64_t>(sum[c]) + static_cast<std::uint64_t>(flux[c]));
}

/// Of what has come to the side, the part that no shot kept apart has brought to elements.
float left_to_gather(const protocol::PatchSide& side, std::size_t c) {
  if (!(side.shot_apart[c] > 0.0F)) return 1.0F;
  return std::max(1.0F - side.shot_apart[c] / static_cast<float>(side.incident[c]), 0.0F);
}

/// What an element's answer brings to the ray's: radiosity times the ray's weight.
protocol::Flux answer_of(const Scene& scene, const protocol::Patch& patch, const protocol::PatchSide& side,
                         const Element& element, const GatherRecord& ray) {
  protocol::Flux flux{};
  for (std::size_t c = 0; c < 3; ++c) {
    const float reflectance = static_cast<float>(patch.reflectance[c]) * 0x1p-32F;
    const float reflected = static_cast<float>(element.flux[c]) * reflectance * element.inverse_area;
    const float emitted = scene.layout.gathers_emission != 0 ? side.emits[c] : 0.0F;
    flux[c] = to_quanta((emitted + reflected * left_to_gather(side, c)) * ray.weight[c]);
  }
  return flux;
}

/// The ray has come to the owner of the element that it met. Ends it, or sends the answer home.
void answer(Pe& pe, Niu& niu, Slot slot, std::uint32_t patch, std::uint32_t side, std::uint32_t element) {
  const auto& ray = pe.slots.at<GatherRecord>(slot);
  const protocol::Patch& met = pe.scene.patches[patch];
  const protocol::PatchSide& of_side = pe.scene.patch_sides[met.side[side]];
  const protocol::Flux flux =
      answer_of(pe.scene, met, of_side, pe.scene.elements[of_side.first_element + element], ray);
  if (ray.home == niu.pe()) {
    add_to_gathered(pe, ray.element, flux);
    end_record(pe, niu, slot);
    return;
  }
  const PeNumber home = ray.home;
  const std::uint32_t of = ray.element;
  auto& record = pe.slots.at<RadiosityRecord>(slot);
  record.flux = flux;
  record.key = of;
  record.kind = RecordKind::answer;
  record.flags = 0;
  pe.outbox.put(niu, pe.slots, home, slot);
}

void ask(Pe& pe, Niu& niu, Slot slot, const Hit& hit) {
  const PhaseMark<Phase::deposit> mark(niu);
  const std::uint32_t side = hit.front ? 0U : 1U;
  if (!is_lit(pe.scene, hit)) {
    end_record(pe, niu, slot);
    return;
  }
  protocol::Weights at{};
  const protocol::PatchReference& owner = owner_of(pe.scene, hit, at);
  if (owner.pe == niu.pe()) {
    const protocol::PatchPart& part = pe.scene.patch_parts[owner.part];
    answer(pe, niu, slot, part.patch, side, protocol::find_leaf(pe.scene.nodes.data(), part.tree, at));
    return;
  }
  auto& record = pe.slots.at<GatherRecord>(slot);
  record.kind = RecordKind::question;
  record.place = owner.part;
  record.polygon = protocol::way_to_leaf(at, owner.levels);
  record.flags = side != 0 ? protocol::kBackSide : std::uint8_t{0};
  pe.outbox.put(niu, pe.slots, owner.pe, slot);
}

/// False: it has ended.
bool pass_pane(const Pe& pe, GatherRecord& record, const Hit& hit) {
  if (++record.bounce >= pe.scene.layout.bounces) return false;
  const protocol::Polygon& polygon = pe.scene.polygons[hit.polygon];
  const protocol::Material& material = pe.scene.materials[polygon.material];
  const glm::vec3 direction = to_vector(record.direction);
  const PaneParts parts =
      pane_parts(direction, unit_normal(polygon), material.refractive_index, to_vector(material.transmittance));
  record.weight = to_array(to_vector(record.weight) * parts.passed);
  turn(record, leaving_point(polygon, to_vector(record.origin) + direction * hit.t), direction, polygon.number);
  record.kind = RecordKind::gather;
  return true;
}

/// Until the ray leaves this PE or ends.
void follow_gather_ray(Pe& pe, Niu& niu, Slot slot) {
  auto& record = pe.slots.at<GatherRecord>(slot);
  for (;;) {
    const Way way = traverse_record(pe, niu, record);
    if (way.end == WayEnd::handed_on) {
      pe.outbox.put(niu, pe.slots, way.next, slot);
      return;
    }
    if (way.end == WayEnd::escaped) {
      end_record(pe, niu, slot);
      return;
    }
    const protocol::MaterialKind kind = pe.scene.materials[pe.scene.polygons[way.hit.polygon].material].kind;
    if (kind == protocol::MaterialKind::pane && pass_pane(pe, record, way.hit)) continue;
    if (protocol::is_specular(kind)) {
      end_record(pe, niu, slot);
    } else {
      ask(pe, niu, slot, way.hit);
    }
    return;
  }
}

void check_answer(const Pe& pe, Niu& niu, const RadiosityRecord& record) {
  require(niu, record.key < pe.scene.elements.size(), RecordField::element, record.key);
  check_flux(niu, record.flux);
}

}  // namespace

void note_areas(const Scene& scene) {
  for (const protocol::Patch& patch : scene.patches) {
    for (const std::uint32_t side : patch.side) {
      if (side == protocol::kNoSide) continue;
      const std::uint32_t first = scene.patch_sides[side].first_element;
      const auto elements = scene.elements.subspan(first, patch.elements);
      for (Element& element : elements) element.inverse_area = 0.0F;
      for (const protocol::Facet& facet : scene.facets.subspan(patch.first_facet, patch.facets))
        elements[facet.element].inverse_area += facet.lit_area;
      for (Element& element : elements)
        element.inverse_area = element.inverse_area > 0.0F ? 1.0F / element.inverse_area : 0.0F;
    }
  }
}

void begin_gathering(const Scene& scene, const protocol::Shoot& shoot) {
  const protocol::Patch& patch = scene.patches[shoot.patch];
  const std::uint32_t first = scene.patch_sides[patch.side[shoot.side]].first_element;
  for (Element& element : scene.elements.subspan(first, patch.elements)) {
    element.gathered = {};
    element.points = 0;
  }
}

GatherPointRecord gathering_point(const Scene& scene, const protocol::Shoot& shoot, std::uint32_t element,
                                  PeNumber home, const protocol::PointRecord& at) {
  const std::uint32_t side = scene.patches[shoot.patch].side[shoot.side];
  const std::uint32_t number = scene.patch_sides[side].first_element + element;
  Element& gathering = scene.elements[number];
  ++gathering.points;
  auto point = std::bit_cast<GatherPointRecord>(at);
  point.element = number;
  const protocol::Flux& lit = scene.patch_sides[side].incident;
  const bool dark = lit[0] == 0 && lit[1] == 0 && lit[2] == 0;
  point.area = dark ? 0.0F : 1.0F / gathering.inverse_area;
  point.home = home;
  point.kind = RecordKind::gather_point;
  return point;
}

void create_gather_ray(Pe& pe, Niu& niu) {
  const Expansion& expansion = pe.expansion;
  const auto point = std::bit_cast<GatherPointRecord>(expansion.point);
  const std::uint32_t rays = protocol::hemicube_pixels(pe.scene.hemicube_grid.n);
  const float weight = point.area / static_cast<float>(rays);
  const Slot slot = pe.slots.take(niu);
  auto& record = pe.slots.at<GatherRecord>(slot);
  record.origin = point.origin;
  record.direction = to_array(cosine_direction(
      expansion.frame, protocol::stratified_pair(expansion.number * rays + expansion.pixel, point.key)));
  record.weight = {weight, weight, weight};
  record.element = point.element;
  record.home = point.home;
  record.place = point.place;
  record.polygon = point.polygon;
  record.key = 0;
  record.kind = RecordKind::gather;
  record.bounce = 0;
  record.flags = protocol::kFirst;
  record.visited = 0;
  --pe.credits.in_hand;
  ++pe.tally.gather_rays;
  ++pe.done.records;
  follow_gather_ray(pe, niu, slot);
}

void check_gather_point(const Pe& pe, Niu& niu, const GatherPointRecord& point) {
  require(niu, gathers(pe.scene.layout), RecordField::kind, static_cast<std::uint32_t>(point.kind));
  require(niu, inside_grid(pe.scene.layout, point.place), RecordField::place, point.place);
  require(niu, point.home < niu.pes(), RecordField::home, point.home);
  require(niu, point.home != niu.pe() || point.element < pe.scene.elements.size(), RecordField::element, point.element);
}

void handle_gather_record(Pe& pe, Niu& niu, Slot slot) {
  const auto& record = pe.slots.at<RadiosityRecord>(slot);
  require(niu, gathers(pe.scene.layout), RecordField::kind, static_cast<std::uint32_t>(record.kind));
  if (record.kind == RecordKind::answer) {
    const PhaseMark<Phase::deposit> mark(niu);
    check_answer(pe, niu, record);
    add_to_gathered(pe, record.key, record.flux);
    end_record(pe, niu, slot);
    return;
  }
  const auto& ray = pe.slots.at<GatherRecord>(slot);
  require(niu, ray.home < niu.pes(), RecordField::home, ray.home);
  require(niu, ray.home != niu.pe() || ray.element < pe.scene.elements.size(), RecordField::element, ray.element);
  if (ray.kind == RecordKind::gather) {
    check_walk(pe, niu, ray);
    follow_gather_ray(pe, niu, slot);
    return;
  }
  const PhaseMark<Phase::deposit> mark(niu);
  const std::uint32_t side = (ray.flags & protocol::kBackSide) != 0 ? 1U : 0U;
  check_landing(pe, niu, ray.place, side);
  const protocol::PatchPart& part = pe.scene.patch_parts[ray.place];
  answer(pe, niu, slot, part.patch, side, protocol::leaf_on_way(pe.scene.nodes.data(), part.tree, ray.polygon));
}

}  // namespace torolux::pe
