// SPDX-License-Identifier: MIT
// Ray records: one sample's light path, followed from the eye. Enters: a record that arrived; leaves: light for a
// pixel, or the record for another PE.
#include "firmware/pe/emitters.hpp"
#include "firmware/pe/follow.hpp"
#include "firmware/pe/glossy.hpp"
#include "firmware/pe/intersect.hpp"
#include "firmware/pe/lamps.hpp"
#include "firmware/pe/layers.hpp"
#include "firmware/pe/sky.hpp"
#include "firmware/pe/specular.hpp"
#include "firmware/pe/surface.hpp"
#include "firmware/protocol/picture_order.hpp"
#include "firmware/protocol/random.hpp"

namespace torolux::pe {
namespace {

using protocol::Branch;
using protocol::Dimension;
using protocol::Material;
using protocol::MaterialKind;
using protocol::Polygon;
using protocol::RayRecord;
using protocol::RecordKind;

/// In any channel above nothing and not below the least weight. A way not taken weighs nothing, so it is never
/// followed.
bool worth_following(const Pe& pe, const glm::vec3& weight) {
  const float least = pe.scene.layout.least_weight;
  const auto counts = [least](float w) { return w > 0.0F && w >= least; };
  return counts(weight.x) || counts(weight.y) || counts(weight.z);
}

/// Light that is a quantum or more in any channel. The least weight is no measure here: a small bright lamp's light is
/// weak against its own radiance wherever it falls.
bool shows(const Pe& pe, const glm::vec3& light) {
  const glm::vec3 quanta = light * pe.scene.layout.pixel_scale;
  return quanta.x >= 0.5F || quanta.y >= 0.5F || quanta.z >= 0.5F;
}

/// What a diffuse surface sends towards the ray: what it emits and what it reflects.
void see_surface(Pe& pe, Niu& niu, const RayRecord& record, const Hit& hit, const glm::vec3& irradiance_over_pi) {
  const Polygon& polygon = pe.scene.polygons[hit.polygon];
  const Material& material = pe.scene.materials[polygon.material];
  glm::vec3 radiance = diffuse_reflectance(pe.scene, polygon, hit) * irradiance_over_pi;
  if (material.lamp != protocol::kNoLamp) {
    radiance += to_vector(material.emission) * lamp_seen(pe.scene, material.lamp, -to_vector(record.direction));
  } else if (hit.front || material.emits_from_back != 0) {
    radiance += to_vector(material.emission);
  }
  pe.results.add_pixel(niu, record.pixel, (to_vector(record.weight) * radiance) * pe.scene.layout.pixel_scale);
}

/// Key of numbers that keep apart over the samples of a pixel, and of neighbours, that come this way: the same bounce,
/// with as many branches waiting.
std::uint32_t way_key(const Pe& pe, const RayRecord& record, Dimension dimension) {
  const std::uint32_t way = protocol::hash_combine(pe.scene.layout.seed, record.bounce * 4U + record.waiting);
  return protocol::hash_combine(way, static_cast<std::uint32_t>(dimension));
}

std::uint32_t place_in_picture(const Pe& pe, const RayRecord& record) {
  const protocol::CameraView& view = pe.scene.layout.view;
  return protocol::place_in_picture(record.pixel % view.width, record.pixel / view.width, record.sample, view.samples);
}

/// A shadow ray has met something: the emitter, a pane, or what else is before it. Glass and mirrors cast shadows: the
/// light that comes by way of them is no emitter's own, and is in the irradiance at vertices. False: it has ended.
bool pass_shadow(Pe& pe, Niu& niu, RayRecord& record, const Hit& hit) {
  const Polygon& polygon = pe.scene.polygons[hit.polygon];
  const Material& material = pe.scene.materials[polygon.material];
  if (material.kind == MaterialKind::pane) {
    // Of two panes in one plane each may lie behind the other, over and over.
    if (++record.bounce >= pe.scene.layout.bounces) return false;
    const glm::vec3 direction = to_vector(record.direction);
    const glm::vec3 passed =
        pane_parts(direction, unit_normal(polygon), material.refractive_index, to_vector(material.transmittance))
            .passed;
    record.weight = to_array(to_vector(record.weight) * passed);
    dim_irradiance(pe, record, passed);
    turn(record, leaving_point(polygon, to_vector(record.origin) + direction * hit.t), direction, polygon.number);
    return true;
  }
  if (polygon.number == record.target)
    pe.results.add_pixel(niu, record.pixel, to_vector(record.weight) * pe.scene.layout.pixel_scale);
  return false;
}

/// Glass's two ways, each with what it weighs, or a pane's.
struct Ways {
  glm::vec3 reflected, refracted;
  glm::vec3 reflected_weight, refracted_weight;
};

Ways ways_at_glass(const RayRecord& record, const Material& glass, const Hit& hit, const glm::vec3& geometric,
                   const glm::vec3& shading) {
  const glm::vec3 in = to_vector(record.direction);
  const glm::vec3 weight = to_vector(record.weight);
  const float eta = hit.front ? 1.0F / glass.refractive_index : glass.refractive_index;
  const Refraction way = refract(in, geometric, shading, eta);
  Ways ways{reflect(in, geometric, shading), way.direction, weight * way.reflectance, glm::vec3(0.0F)};
  // A ray keeps its radiance over the square of the refractive index (Born & Wolf, Principles of Optics, 4.8).
  const glm::vec3 passes = to_vector(glass.transmittance) * (eta * eta);
  if (way.reflectance < 1.0F) ways.refracted_weight = (weight * (1.0F - way.reflectance)) * passes;
  if (record.waiting == protocol::kMostBranches &&
      way.reflectance < 1.0F) {  // no room for a branch: take one by chance
    const bool reflects = protocol::uniform(record.key, Dimension::fresnel) < way.reflectance;
    ways.reflected_weight = reflects ? weight : glm::vec3(0.0F);
    ways.refracted_weight = reflects ? glm::vec3(0.0F) : weight * passes;
  }
  return ways;
}

Ways ways_at_pane(const RayRecord& record, const Material& glass, const glm::vec3& geometric) {
  const glm::vec3 in = to_vector(record.direction);
  const glm::vec3 weight = to_vector(record.weight);
  const PaneParts parts = pane_parts(in, geometric, glass.refractive_index, to_vector(glass.transmittance));
  Ways ways{reflect(in, geometric, geometric), in, weight * parts.reflected, weight * parts.passed};
  if (record.waiting == protocol::kMostBranches) {  // no room for a branch: take one by chance
    const bool reflects = protocol::uniform(record.key, Dimension::fresnel) < parts.reflectance;
    const float chance = reflects ? parts.reflectance : 1.0F - parts.reflectance;
    ways.reflected_weight *= reflects ? 1.0F / chance : 0.0F;
    ways.refracted_weight *= reflects ? 0.0F : 1.0F / chance;
  }
  return ways;
}

/// A way from the surface at which the record is, beginning in the same subspace.
struct Onward {
  glm::vec3 origin, direction, weight;
  std::uint32_t polygon;  ///< global
  std::uint32_t key;
  std::uint8_t bounce;
};

/// It waits inside the record, which has room, until the present way has ended.
void add_branch(RayRecord& record, const Onward& way) {
  Branch& branch = record.branches[record.waiting++];
  branch.origin = to_array(way.origin);
  branch.direction = to_array(way.direction);
  branch.weight = to_array(way.weight);
  branch.place = record.place;
  branch.polygon = way.polygon;
  branch.key = way.key;
  branch.bounce = way.bounce;
  branch.flags = 0;
}

void take(RayRecord& record, const Onward& way) {
  record.weight = to_array(way.weight);
  record.key = way.key;
  record.bounce = way.bounce;
  turn(record, way.origin, way.direction, way.polygon);
}

/// From here on it is a shadow ray. Panes on its way count as segments, so a flag keeps that it left the first surface.
void cast_shadow(RayRecord& record) {
  record.flags |= protocol::kShadow;
  if (record.bounce == 0) record.flags |= protocol::kDirect;
}

/// A shadow ray that might go: the light of the sun, or of all other emitters.
struct Aim {
  EmitterSample from;
  glm::vec3 weight;  ///< the light that it brings to the pixel
  bool goes;
};

void decide(const Pe& pe, const RayRecord& record, const glm::vec3& reflectance, Aim& aim) {
  if (!aim.goes) return;
  aim.weight = to_vector(record.weight) * reflectance * aim.from.irradiance_over_pi;
  if (shows(pe, aim.weight)) return;
  aim.weight = glm::vec3(0.0F);
  aim.goes = wants_irradiance(pe, record);
}

/// No way may wait beside those that do: of two rays one goes, by what they bring, each at least once in four times.
void choose_one(const RayRecord& record, Aim& sun, Aim& others) {
  const float by_sun = brings(sun.from);
  const float chance = glm::clamp(by_sun / (by_sun + brings(others.from)), 0.25F, 0.75F);
  sun.goes = protocol::uniform(record.key, Dimension::emitter) < chance;
  others.goes = !sun.goes;
  Aim& chosen = sun.goes ? sun : others;
  const float inverse = 1.0F / (sun.goes ? chance : 1.0F - chance);
  chosen.weight *= inverse;
  chosen.from.irradiance_over_pi *= inverse;
}

/// From a diffuse surface on towards an emitter, if shadow rays are asked for; where the sun may shine and no other way
/// waits, its ray waits for that to the others. False: no light comes.
bool aim_at_emitters(const Pe& pe, RayRecord& record, const Hit& hit) {
  if (pe.scene.emitters.empty()) return false;
  const Polygon& polygon = pe.scene.polygons[hit.polygon];
  const glm::vec3 to_side = hit.front ? glm::vec3(1.0F) : glm::vec3(-1.0F);
  const glm::vec3 origin = leaving_point(polygon, to_vector(record.origin) + to_vector(record.direction) * hit.t);
  const glm::vec3 normal = shading_normal(pe.scene, polygon, hit) * to_side;
  const glm::vec3 geometric = unit_normal(polygon) * to_side;
  const std::uint32_t place = place_in_picture(pe, record);
  const std::uint32_t key = way_key(pe, record, Dimension::emitter);
  protocol::StratifiedTriple numbers = protocol::stratified_triple(place, key);
  // The third has no more than 2^16 values: others in each part of the picture, or an emitter might lie between them.
  numbers.z ^= protocol::hash_combine(key, ~(place >> 16U));
  Aim sun{};
  Aim others{};
  sun.goes = sample_sun(pe.scene, numbers, origin, normal, geometric, sun.from);
  others.goes = sample_emitter(pe.scene, numbers, origin, normal, geometric, others.from);
  const glm::vec3 diffuse = diffuse_reflectance(pe.scene, polygon, hit);
  decide(pe, record, diffuse, sun);
  decide(pe, record, diffuse, others);
  if (sun.goes && others.goes) {
    if (record.waiting != 0) {
      choose_one(record, sun, others);
    } else {
      note_sun_irradiance(record, sun.from.irradiance_over_pi);
      add_branch(record, {origin, sun.from.direction, sun.weight, polygon.number, record.key, record.bounce});
      record.branches[0].flags = protocol::kShadow;
    }
  }
  const Aim& aim = others.goes ? others : sun;
  if (!aim.goes) return false;
  note_irradiance(pe, record, aim.from.irradiance_over_pi);
  record.weight = to_array(aim.weight);
  record.target = aim.from.polygon;
  turn(record, origin, aim.from.direction, polygon.number);
  cast_shadow(record);
  return true;
}

/// The way by a glossy surface's lobe. False: none that is worth following.
bool choose_lobe(const Pe& pe, const RayRecord& record, const Hit& hit, Onward& way) {
  if (record.bounce + 1U >= pe.scene.layout.bounces) return false;
  const Polygon& polygon = pe.scene.polygons[hit.polygon];
  const Material& material = pe.scene.materials[polygon.material];
  way.bounce = static_cast<std::uint8_t>(record.bounce + 1U);
  way.key = protocol::hash_combine(record.key, way.bounce);
  const glm::vec3 in = to_vector(record.direction);
  const protocol::StratifiedPair numbers =
      protocol::stratified_pair(place_in_picture(pe, record), way_key(pe, record, Dimension::lobe));
  const LobeSample lobe = sample_lobe(material, in, unit_normal(polygon), shading_normal(pe.scene, polygon, hit),
                                      protocol::uniform_float(numbers.x), protocol::uniform_float(numbers.y));
  way.origin = leaving_point(polygon, to_vector(record.origin) + in * hit.t);
  way.direction = lobe.direction;
  way.weight = to_vector(record.weight) * to_vector(material.specular) * lobe.cosine;
  way.polygon = polygon.number;
  return worth_following(pe, way.weight);
}

/// From a diffuse or glossy surface on: by the lobe, and towards emitters, if shadow rays are asked for; one of them
/// waits for the other, or where there is no room, one is taken by chance. False: there is neither.
bool scatter(const Pe& pe, RayRecord& record, const Hit& hit) {
  Onward lobe;
  const MaterialKind kind = pe.scene.materials[pe.scene.polygons[hit.polygon].material].kind;
  if (kind != MaterialKind::glossy || !choose_lobe(pe, record, hit, lobe)) return aim_at_emitters(pe, record, hit);
  bool by_lobe = pe.scene.emitters.empty();
  if (!by_lobe && record.waiting == protocol::kMostBranches) {
    by_lobe = protocol::uniform(lobe.key, Dimension::branch) < 0.5F;
    lobe.weight *= 2.0F;
    record.weight = to_array(to_vector(record.weight) * 2.0F);
    if (!by_lobe) return aim_at_emitters(pe, record, hit);
  }
  if (by_lobe) {
    take(record, lobe);
    return true;
  }
  add_branch(record, lobe);
  return aim_at_emitters(pe, record, hit);
}

/// Turns the ray at mirror, glass or pane. False: nothing of it is worth following.
bool turn_ray(const Pe& pe, RayRecord& record, const Hit& hit) {
  ++record.bounce;
  if (record.bounce >= pe.scene.layout.bounces) return false;
  const Polygon& polygon = pe.scene.polygons[hit.polygon];
  const Material& material = pe.scene.materials[polygon.material];
  const glm::vec3 in = to_vector(record.direction);
  const glm::vec3 origin = leaving_point(polygon, to_vector(record.origin) + in * hit.t);
  const glm::vec3 geometric = unit_normal(polygon);
  const glm::vec3 shading = shading_normal(pe.scene, polygon, hit);
  record.key = protocol::hash_combine(record.key, record.bounce);
  if (material.kind == MaterialKind::mirror) {
    const glm::vec3 weight = to_vector(record.weight) * to_vector(material.specular);
    if (!worth_following(pe, weight)) return false;
    record.weight = to_array(weight);
    turn(record, origin, reflect(in, geometric, shading), polygon.number);
    return true;
  }
  const Ways ways = material.kind == MaterialKind::pane ? ways_at_pane(record, material, geometric)
                                                        : ways_at_glass(record, material, hit, geometric, shading);
  const bool reflects = worth_following(pe, ways.reflected_weight);
  const bool refracts = worth_following(pe, ways.refracted_weight);
  if (!reflects && !refracts) return false;
  if (reflects && refracts) {  // the reflected way waits until the refracted one has ended
    const std::uint32_t key = protocol::hash_combine(record.key, static_cast<std::uint32_t>(Dimension::branch));
    add_branch(record, {origin, ways.reflected, ways.reflected_weight, polygon.number, key, record.bounce});
  }
  record.weight = to_array(refracts ? ways.refracted_weight : ways.reflected_weight);
  turn(record, origin, refracts ? ways.refracted : ways.reflected, polygon.number);
  return true;
}

void resume_branch(RayRecord& record) {
  const Branch& branch = record.branches[--record.waiting];
  record.origin = branch.origin;
  record.direction = branch.direction;
  record.weight = branch.weight;
  record.place = branch.place;
  record.polygon = branch.polygon;
  record.key = branch.key;
  record.bounce = branch.bounce;
  record.flags = protocol::kFirst;  // whatever came with it: a branch begins where it waits
  record.kind = RecordKind::light;
  if (branch.flags == 0) return;
  cast_shadow(record);
  record.target = protocol::kSkyTarget;
  take_sun_irradiance(record);
}

/// The current path has ended. True: a branch of it goes on, here.
bool next_path(Pe& pe, Niu& niu, Slot slot) {
  auto& record = pe.slots.at<RayRecord>(slot);
  if (record.waiting == 0) {
    end_record(pe, niu, slot);
    return false;
  }
  resume_branch(record);
  return true;
}

/// The surface that a record of kind `shade` has met at another PE, met again: the same floats, so the same hit.
Way meet_again(Pe& pe, Niu& niu, RayRecord& record) {
  const PhaseMark<Phase::traverse> mark(niu);
  const glm::vec3 origin = to_vector(record.origin);
  const glm::vec3 direction = to_vector(record.direction);
  const Shear shear(origin, direction, Inverse(direction));
  const std::uint32_t polygon = pe.scene.kept[record.target].polygon;
  Crossing crossing;
  const bool meets = cross_triangle(shear, pe.scene.polygons[polygon], crossing);
  require(niu, meets, RecordField::surface, record.target);
  Way way{};
  way.end = WayEnd::hit;
  way.hit = hit_of(crossing, crossing.t, polygon);
  return way;
}

enum class Next : std::uint8_t { goes_on, ended, sent };

/// At the surface that it has met. `sent`: to the keeper of what is seen there.
Next meet_surface(Pe& pe, Niu& niu, Slot slot, const Hit& hit) {
  const PhaseMark<Phase::shade> mark(niu);
  auto& record = pe.slots.at<RayRecord>(slot);
  const auto next = [](bool goes_on) { return goes_on ? Next::goes_on : Next::ended; };
  if ((record.flags & protocol::kShadow) != 0) return next(pass_shadow(pe, niu, record, hit));
  const Polygon& polygon = pe.scene.polygons[hit.polygon];
  const SurfaceLight light = light_at(pe.scene, niu.pe(), polygon, hit);
  // A record that goes from PE to PE would never end.
  require(niu, light.here || record.kind == RecordKind::light, RecordField::surface, record.target);
  if (!light.here) {
    record.kind = RecordKind::shade;
    record.target = light.place;
    pe.outbox.put(niu, pe.slots, light.keeper, slot);
    return Next::sent;
  }
  record.kind = RecordKind::light;
  note_surface(pe, niu, record, hit, light.irradiance_over_pi);
  if (is_specular(pe.scene.materials[polygon.material].kind)) return next(turn_ray(pe, record, hit));
  see_surface(pe, niu, record, hit, light.irradiance_over_pi);
  return next(scatter(pe, record, hit));
}

}  // namespace

void follow_ray(Pe& pe, Niu& niu, Slot slot) {
  auto& record = pe.slots.at<RayRecord>(slot);
  for (;;) {
    const Way way = record.kind == RecordKind::shade ? meet_again(pe, niu, record) : traverse_record(pe, niu, record);
    if (pe.scene.layout.layers != 0) note_way(pe, niu, record, way);
    if (way.end == WayEnd::handed_on) {
      pe.outbox.put(niu, pe.slots, way.next, slot);
      return;
    }
    if (way.end == WayEnd::escaped) see_sky(pe, niu, record);
    const Next next = way.end == WayEnd::hit ? meet_surface(pe, niu, slot, way.hit) : Next::ended;
    if (next == Next::sent || (next == Next::ended && !next_path(pe, niu, slot))) return;
  }
}

namespace {

void check_surface(const Pe& pe, Niu& niu, const RayRecord& record) {
  require(niu, record.target < pe.scene.kept.size(), RecordField::surface, record.target);
  require(niu, (record.flags & protocol::kShadow) == 0, RecordField::surface, record.flags);
}

void check_ray(const Pe& pe, Niu& niu, const RayRecord& record) {
  const bool shade = record.kind == RecordKind::shade;
  require(niu, record.kind == RecordKind::light || shade, RecordField::kind, static_cast<std::uint32_t>(record.kind));
  if (shade) check_surface(pe, niu, record);
  require(niu, record.waiting <= protocol::kMostBranches, RecordField::waiting, record.waiting);
  for (std::uint32_t i = 0; i < record.waiting; ++i) {
    const Branch& branch = record.branches[i];
    require(niu, inside_grid(pe.scene.layout, branch.place), RecordField::branch_place, branch.place);
    require(niu, branch.flags == 0 || branch.flags == protocol::kShadow, RecordField::branch_flags, branch.flags);
  }
  check_walk(pe, niu, record);
}

}  // namespace

void handle_ray(Pe& pe, Niu& niu, Slot slot) {
  check_slot(pe, niu, slot);
  auto& record = pe.slots.at<RayRecord>(slot);
  check_ray(pe, niu, record);
  follow_ray(pe, niu, slot);
}

}  // namespace torolux::pe
