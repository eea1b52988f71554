// SPDX-License-Identifier: MIT
// Hits are Embree's, in floats about the scene's middle, without the triangles that a path leaves or aims at. Texels,
// emission and chances of emitters are computed apart from the product's code.
#include "tests/references/world.hpp"

#include <embree3/rtcore.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace torolux::references {
namespace {

Material read_material(const SceneMaterial& from) {
  Material material;
  material.diffuse = colour(from.diffuse);
  material.texture = from.texture;
  material.emission = colour(from.emission);
  material.lamp = from.lamp;
  switch (from.kind) {
    case SurfaceKind::diffuse:
      if (!is_glossy(from)) break;
      material.model = Model::glossy;
      material.specular = colour(from.specular);
      material.exponent = from.exponent;
      break;
    case SurfaceKind::mirror:
      material.model = Model::mirror;
      material.specular = colour(from.specular);
      break;
    case SurfaceKind::glass:
      material.model = from.thin ? Model::pane : Model::glass;
      material.transmittance = colour(from.transmittance);
      material.refractive_index = from.refractive_index;
      break;
  }
  return material;
}

/// sRGB, IEC 61966-2-1.
double linear(std::uint8_t value) {
  const double v = value / 255.0;
  return v > 0.04045 ? std::pow((v + 0.055) / 1.055, 2.4) : v / 12.92;
}

/// What Embree hands through to the filter.
struct Query {
  RTCIntersectContext context;  // first: Embree knows only this
  std::uint32_t leaving;
  std::uint32_t target;
};

void pass_over(const RTCFilterFunctionNArguments* arguments) {
  const auto* query = reinterpret_cast<const Query*>(arguments->context);
  for (unsigned i = 0; i < arguments->N; ++i) {
    const std::uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
    if (triangle == query->leaving || triangle == query->target) arguments->valid[i] = 0;
  }
}

Query query(std::uint32_t leaving, std::uint32_t target) {
  Query result{};
  rtcInitIntersectContext(&result.context);
  result.context.filter = pass_over;
  result.leaving = leaving;
  result.target = target;
  return result;
}

void set_ray(RTCRay& ray, const Vec& origin, const Vec& direction, float far) {
  ray.org_x = static_cast<float>(origin.x());
  ray.org_y = static_cast<float>(origin.y());
  ray.org_z = static_cast<float>(origin.z());
  ray.dir_x = static_cast<float>(direction.x());
  ray.dir_y = static_cast<float>(direction.y());
  ray.dir_z = static_cast<float>(direction.z());
  ray.tnear = 0;
  ray.tfar = far;
  ray.time = 0;
  ray.mask = ~0U;
  ray.id = 0;
  ray.flags = 0;
}

}  // namespace

/// Embree's scene, with the middle of the bounding box as origin, where floats are finest.
struct World::RayCaster {
  explicit RayCaster(const std::vector<Triangle>& triangles) {
    if (device == nullptr) throw std::runtime_error("Embree does not start");
    Vec low = Vec::Constant(HUGE_VAL);
    Vec high = -low;
    for (const Triangle& triangle : triangles) {
      for (const Vec& corner : triangle.corner) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
      }
    }
    middle = (low + high) / 2;
    size = (high - low).maxCoeff();
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertex = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                               3 * sizeof(float), 3 * triangles.size()));
    auto* index = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
    std::uint32_t next = 0;
    for (const Triangle& triangle : triangles) {
      for (const Vec& corner : triangle.corner) {
        for (int axis = 0; axis < 3; ++axis) *vertex++ = static_cast<float>(corner[axis] - middle[axis]);
        *index++ = next++;
      }
    }
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene, static_cast<RTCSceneFlags>(RTC_SCENE_FLAG_ROBUST | RTC_SCENE_FLAG_CONTEXT_FILTER_FUNCTION));
    rtcCommitScene(scene);
    if (rtcGetDeviceError(device) != RTC_ERROR_NONE) throw std::runtime_error("Embree does not take the scene");
  }
  RayCaster(const RayCaster&) = delete;
  RayCaster& operator=(const RayCaster&) = delete;
  ~RayCaster() {
    rtcReleaseScene(scene);
    rtcReleaseDevice(device);
  }

  RTCDevice device = rtcNewDevice("threads=1");
  RTCScene scene = rtcNewScene(device);
  Vec middle = Vec::Zero();
  double size = 1;  ///< longest edge of the bounding box
};

std::vector<Material> materials_of(const Scene& scene) {
  std::vector<Material> materials;
  for (const SceneMaterial& material : scene.materials) materials.push_back(read_material(material));
  return materials;
}

World::World(const Scene& scene, std::vector<Material> materials, bool two_sided_lights)
    : materials_(std::move(materials)),
      textures_(scene.textures),
      sky_(scene.sky),
      two_sided_lights_(two_sided_lights) {
  for (const SceneTriangle& from : scene.triangles) {
    Triangle& triangle = triangles_.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) triangle.corner[i] = vec(scene.positions[from.position[i]]);
    const Vec across = (triangle.corner[1] - triangle.corner[0]).cross(triangle.corner[2] - triangle.corner[0]);
    triangle.area = across.norm() / 2;
    triangle.normal = across.normalized();
    triangle.material = from.material;
    if (from.texture_points != kNoImage) {
      auto& points = triangle.texture_points.emplace();
      for (std::size_t i = 0; i < 3; ++i) points[i] = scene.texture_points[from.texture_points + i];
    }
    if (from.normal[0] == kNoNormal) continue;
    auto& normals = triangle.corner_normals.emplace();
    for (std::size_t i = 0; i < 3; ++i) normals[i] = vec(scene.normals[from.normal[i]]);
  }
  caster_ = std::make_unique<RayCaster>(triangles_);
  // Some 30 units in the last place of the greatest coordinate.
  offset_ = 4e-6 * caster_->size;
  for (const SceneLamp& lamp : scene.lamps) lamps_.emplace_back(scene.webs[lamp.web], lamp);
  collect_emitters();
}

double World::size() const {
  return caster_->size;
}

World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

void World::collect_emitters() {
  emitter_of_.assign(triangles_.size(), kNoTriangle);
  for (std::uint32_t t = 0; t < triangles_.size(); ++t) {
    const Triangle& triangle = triangles_[t];
    const double power = materials_[triangle.material].emission.mean() * triangle.area;
    if (!(power > 0)) continue;
    emitter_of_[t] = static_cast<std::uint32_t>(emitters_.size());
    const bool around = two_sided_lights_ || materials_[triangle.material].lamp != kNoMeasuredLamp;
    emitters_.push_back({t, power, around, (triangle.corner[0] + triangle.corner[1] + triangle.corner[2]) / 3});
  }
}

/// By the square of the distance, as if nothing were between; no more than that close by, where that would overrate it.
double World::expected_light(const Emitter& emitter, const Vec& point) const {
  const Triangle& triangle = triangles_[emitter.triangle];
  const Vec way = point - emitter.centre;
  if (!emitter.around && way.dot(triangle.normal) <= 0) return 0;
  return emitter.power / (way.squaredNorm() + triangle.area);
}

Colour World::diffuse_at(const Hit& hit) const {
  const Material& surface = material(hit);
  const Triangle& triangle = triangles_[hit.triangle];
  if (surface.texture == kNoImage || !triangle.texture_points) return surface.diffuse;
  const SceneTexture& texture = textures_[surface.texture];
  const auto& points = *triangle.texture_points;
  const auto size = std::array<double, 2>{static_cast<double>(texture.width), static_cast<double>(texture.height)};
  std::array<double, 2> at{};
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const double place = points[0][axis] * (1 - hit.b1 - hit.b2) + points[1][axis] * hit.b1 + points[2][axis] * hit.b2;
    at[axis] = (texture.clamped ? std::clamp(place, 0.0, 1.0) : place - std::floor(place)) * size[axis] - 0.5;
  }
  const auto index = [&](double x, double end) {
    const double over = texture.clamped ? 1 : end;
    return static_cast<std::size_t>(x < 0 ? x + over : x >= end ? x - over : x);
  };
  Colour sum = Colour::Zero();
  for (const double up : {0.0, 1.0}) {
    for (const double across : {0.0, 1.0}) {
      const double x = std::floor(at[0]) + across;
      const double y = std::floor(at[1]) + up;
      const double share = (1 - std::fabs(at[0] - x)) * (1 - std::fabs(at[1] - y));
      const auto& texel = texture.texels[index(y, size[1]) * texture.width + index(x, size[0])];
      for (int c = 0; c < 3; ++c) sum[c] += share * linear(texel[static_cast<std::size_t>(c)]);
    }
  }
  return surface.diffuse * sum;
}

Colour World::emission(const Hit& hit, const Vec& out, double least_cosine) const {
  const Material& surface = material(hit);
  if (surface.lamp == kNoMeasuredLamp) return hit.front || two_sided_lights_ ? surface.emission : Colour::Zero();
  const double cosine = std::fabs(out.dot(triangles_[hit.triangle].normal));
  return surface.emission * (lamps_[surface.lamp].intensity(out) / std::max(cosine, least_cosine));
}

Colour World::emission_at(const Hit& hit, const Vec& out) const {
  return emission(hit, out, 1e-9);
}

Colour World::emission_seen(const Hit& hit, const Vec& out) const {
  return emission(hit, out, 0.125);
}

bool World::shines_around(std::uint32_t triangle) const {
  return emitter_of_[triangle] != kNoTriangle && emitters_[emitter_of_[triangle]].around;
}

double World::light_density(const Vec& point, const Hit& hit) const {
  if (emitter_of_[hit.triangle] == kNoTriangle || (!hit.front && !shines_around(hit.triangle))) return 0;
  double all = 0;
  for (const Emitter& emitter : emitters_) all += expected_light(emitter, point);
  if (!(all > 0)) return 0;
  return expected_light(emitters_[emitter_of_[hit.triangle]], point) / (all * triangles_[hit.triangle].area);
}

EmitterChoice World::pick_emitter(const Vec& point, double uniform) const {
  double all = 0;
  for (const Emitter& emitter : emitters_) all += expected_light(emitter, point);
  double rest = uniform * all;
  EmitterChoice choice{kNoTriangle, 0};
  for (const Emitter& emitter : emitters_) {
    const double expected = expected_light(emitter, point);
    if (!(expected > 0)) continue;
    choice = {emitter.triangle, expected / (all * triangles_[emitter.triangle].area)};
    rest -= expected;
    if (rest < 0) break;
  }
  return choice;
}

Hit World::at(std::uint32_t triangle, double b1, double b2, bool front) const {
  const auto& corner = triangles_[triangle].corner;
  return {triangle, b1, b2, front, corner[0] * (1 - b1 - b2) + corner[1] * b1 + corner[2] * b2};
}

Vec World::shading_normal(const Hit& hit) const {
  const Triangle& triangle = triangles_[hit.triangle];
  if (!triangle.corner_normals) return triangle.normal;
  const auto& normal = *triangle.corner_normals;
  return (normal[0] * (1 - hit.b1 - hit.b2) + normal[1] * hit.b1 + normal[2] * hit.b2).normalized();
}

std::optional<Hit> World::closest(const Vec& origin, const Vec& direction, std::uint32_t leaving) const {
  Query way = query(leaving, kNoTriangle);
  RTCRayHit ray{};
  set_ray(ray.ray, origin - caster_->middle, direction, HUGE_VALF);
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  rtcIntersect1(caster_->scene, &way.context, &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return std::nullopt;
  const bool front = direction.dot(triangles_[ray.hit.primID].normal) < 0;
  return at(ray.hit.primID, static_cast<double>(ray.hit.u), static_cast<double>(ray.hit.v), front);
}

bool World::blocked(const Vec& from, const Vec& to, std::uint32_t leaving, std::uint32_t target) const {
  Query way = query(leaving, target);
  RTCRay ray{};
  // Stops short of the target, where rounding could find its neighbour in the same plane.
  set_ray(ray, from - caster_->middle, to - from, 1 - 1e-5F);
  rtcOccluded1(caster_->scene, &way.context, &ray);
  return ray.tfar < 0;
}

bool World::has_panes() const {
  return std::ranges::any_of(materials_, [](const Material& material) { return material.model == Model::pane; });
}

Vec World::leave(const Hit& hit, const Vec& direction) const {
  const Vec& normal = triangles_[hit.triangle].normal;
  return hit.point + normal * (direction.dot(normal) < 0 ? -offset_ : offset_);
}

}  // namespace torolux::references
