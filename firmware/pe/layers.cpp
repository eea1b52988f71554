// SPDX-License-Identifier: MIT
// What a camera ray's first surface is, and how many subspaces its ways went through. Irradiance from an emitter waits
// in the record until the shadow ray has got there.
#include "firmware/pe/layers.hpp"

#include "firmware/pe/surface.hpp"
#include "firmware/protocol/triangle_grid.hpp"

namespace torolux::pe {
namespace {

using protocol::Plane;
using protocol::Polygon;
using protocol::RayRecord;

bool wanted(const Pe& pe, Plane plane) {
  return (pe.scene.layout.layers & protocol::plane_bit(plane)) != 0;
}

/// Until a ray has met its second surface, no more than one branch waits: the last one's room is free.
protocol::Vec3f& carried_irradiance(RayRecord& record) {
  return record.branches[protocol::kMostBranches - 1U].weight;
}
const protocol::Vec3f& carried_irradiance(const RayRecord& record) {
  return record.branches[protocol::kMostBranches - 1U].weight;
}
/// And of the ray to the sun that waits.
protocol::Vec3f& sun_irradiance(RayRecord& record) {
  return record.branches[protocol::kMostBranches - 1U].direction;
}

void add_irradiance(Pe& pe, Niu& niu, const RayRecord& record, const glm::vec3& over_pi) {
  const glm::vec3 value = over_pi * pe.scene.layout.pixel_scale;
  pe.results.add(niu, Plane::irradiance, record.pixel, {to_quanta(value.x), to_quanta(value.y), to_quanta(value.z)});
}

void note_depth(Pe& pe, Niu& niu, const RayRecord& record, const Hit& hit) {
  pe.results.add(niu, Plane::depth, record.pixel, {to_quanta(hit.t / protocol::kLayerUnit), 1, 0});
}

void note_normal(Pe& pe, Niu& niu, const RayRecord& record, const Polygon& polygon, const Hit& hit) {
  const glm::vec3 normal = shading_normal(pe.scene, polygon, hit) * ((hit.front ? 1.0F : -1.0F) / protocol::kLayerUnit);
  pe.results.add(niu, Plane::normals, record.pixel, {to_quanta(normal.x), to_quanta(normal.y), to_quanta(normal.z)});
}

/// The element under a hit. The host makes a number of it (host_tools/render/frame_layers.cpp).
void note_element(Pe& pe, Niu& niu, const RayRecord& record, const Polygon& polygon, const Hit& hit) {
  const std::int64_t code = element_code_at(pe.scene, polygon, hit);
  pe.results.add(niu, Plane::elements, record.pixel, {std::int64_t{polygon.number} + 1, code, hit.front ? 0 : 1});
}

/// It brings light to the surface that the camera ray met first.
bool casts_shadow_on_first(const RayRecord& record) {
  constexpr std::uint32_t both = protocol::kShadow | protocol::kDirect;
  return (record.flags & both) == both;
}

}  // namespace

void note_surface(Pe& pe, Niu& niu, const RayRecord& record, const Hit& hit, const glm::vec3& irradiance_over_pi) {
  if (pe.scene.layout.layers == 0 || record.bounce != 0) return;
  const Polygon& polygon = pe.scene.polygons[hit.polygon];
  if (wanted(pe, Plane::irradiance)) {
    add_irradiance(pe, niu, record, to_vector(record.weight) * irradiance_over_pi);
  }
  if (wanted(pe, Plane::depth)) note_depth(pe, niu, record, hit);
  if (wanted(pe, Plane::normals)) note_normal(pe, niu, record, polygon, hit);
  if (record.sample != 0) return;
  if (wanted(pe, Plane::elements)) note_element(pe, niu, record, polygon, hit);
  if (wanted(pe, Plane::owner)) {
    pe.results.add(niu, Plane::owner, record.pixel, {std::int64_t{niu.pe()} + 1, 0, 0});
  }
}

void note_way(Pe& pe, Niu& niu, const RayRecord& record, const Way& way) {
  if (wanted(pe, Plane::cost)) pe.results.add(niu, Plane::cost, record.pixel, {way.visited, 0, 0});
  if (way.end == WayEnd::handed_on || !casts_shadow_on_first(record)) return;
  const std::uint32_t met = way.end == WayEnd::hit ? pe.scene.polygons[way.hit.polygon].number : protocol::kSkyTarget;
  if (wanted(pe, Plane::irradiance) && met == record.target) {
    add_irradiance(pe, niu, record, to_vector(carried_irradiance(record)));
  }
}

bool wants_irradiance(const Pe& pe, const RayRecord& record) {
  return record.bounce == 0 && wanted(pe, Plane::irradiance);
}

void note_irradiance(const Pe& pe, RayRecord& record, const glm::vec3& irradiance_over_pi) {
  if (!wants_irradiance(pe, record)) return;
  carried_irradiance(record) = to_array(to_vector(record.weight) * irradiance_over_pi);
}

void note_sun_irradiance(RayRecord& record, const glm::vec3& irradiance_over_pi) {
  sun_irradiance(record) = to_array(to_vector(record.weight) * irradiance_over_pi);
}

void take_sun_irradiance(RayRecord& record) {
  carried_irradiance(record) = sun_irradiance(record);
}

void dim_irradiance(const Pe& pe, RayRecord& record, const glm::vec3& passed) {
  if (!wanted(pe, Plane::irradiance) || !casts_shadow_on_first(record)) return;
  carried_irradiance(record) = to_array(to_vector(carried_irradiance(record)) * passed);
}

}  // namespace torolux::pe
