// SPDX-License-Identifier: MIT
// Parts of the sky get chances by their radiance, each channel over its sum: so none of a record's channels is ever
// many times the mean.
#include "host_tools/layout/sky_tables.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host_tools/layout/chances.hpp"
#include "host_tools/scene/sky.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// The faces of the object space, each a corner and two edges; along x across points inwards.
std::vector<SkyQuad> faces(const SceneSpace& space) {
  std::vector<SkyQuad> quads;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const bool upper : {false, true}) {
      SkyQuad quad{};
      const std::size_t first = (axis + (upper ? 2U : 1U)) % 3U;
      const std::size_t second = (axis + (upper ? 1U : 2U)) % 3U;
      if (upper) quad.corner[axis] = space.size[axis];
      quad.along[first] = space.size[first];
      quad.across[second] = space.size[second];
      quads.push_back(quad);
    }
  }
  return quads;
}

/// In the units of the normalised scene.
std::vector<SkyQuad> openings(const Sky& sky, const SceneSpace& space) {
  if (sky.openings.empty()) return faces(space);
  std::vector<SkyQuad> quads;
  for (const SkyQuad& quad : sky.openings)
    quads.push_back(
        {space.to_normalised(quad.corner), vec::scale(quad.along, space.scale), vec::scale(quad.across, space.scale)});
  return quads;
}

}  // namespace

std::vector<SkyInlet> sky_inlets(const Scene& scene, const SceneSpace& space) {
  std::vector<SkyInlet> inlets;
  if (!scene.sky) return inlets;
  const Vec3d everywhere = sky_from_everywhere(*scene.sky);
  for (const SkyQuad& quad : openings(*scene.sky, space)) {
    const Vec3d across = vec::cross(quad.along, quad.across);
    const double area = vec::length(across) / (space.scale * space.scale);
    const Vec3d inwards = vec::unit(across);
    SkyInlet inlet;
    inlet.opening = {to_float(quad.corner), to_float(quad.along), to_float(quad.across), to_float(inwards)};
    inlet.flux = vec::scale(sky_irradiance(*scene.sky, vec::scale(inwards, -1)), area);
    inlet.all = vec::scale(everywhere, area);
    if (vec::largest(inlet.flux) > 0) inlets.push_back(inlet);
  }
  return inlets;
}

SkyTables sky_tables(const Scene& scene, const LightUnits& units) {
  SkyTables tables;
  if (!scene.sky) return tables;
  const Sky& sky = *scene.sky;
  const Vec3d everywhere = sky_from_everywhere(sky);
  const double unit = units.unit_radiance;
  protocol::SkyFrame& frame = tables.frame;
  frame.x = to_float(sky.east);
  frame.y = to_float(sky.north);
  frame.up = to_float(sky.up);
  frame.sun = to_float(sky.sun);
  const Vec3d aside = std::abs(sky.sun[0]) > 0.5 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
  const Vec3d sun_x = vec::unit(vec::cross(aside, sky.sun));
  frame.sun_x = to_float(sun_x);
  frame.sun_y = to_float(vec::cross(sky.sun, sun_x));
  const bool has_sun = vec::largest(sky.sun_irradiance) > 0;
  frame.sun_tangent = has_sun ? static_cast<float>(std::tan(kSunRadiusDegrees * (std::numbers::pi / 180))) : 0.0F;
  for (std::size_t c = 0; c < 3; ++c)
    frame.inverse_irradiance[c] = everywhere[c] > 0 ? static_cast<float>(unit / everywhere[c]) : 0.0F;

  const auto weight = [&everywhere](const Vec3d& light) {
    double sum = 0;
    for (std::size_t c = 0; c < 3; ++c) sum += everywhere[c] > 0 ? light[c] / everywhere[c] : 0;
    return sum;
  };
  std::vector<double> weights;
  for (std::size_t cell = 0; cell < sky.radiance.size(); ++cell)
    weights.push_back(weight(vec::scale(sky.radiance[cell], sky_cell_solid_angle(cell))));
  weights.push_back(weight(sky.sun_irradiance));
  const std::vector<std::uint32_t> chosen_to = chances(weights);
  for (std::size_t cell = 0; cell < sky.radiance.size(); ++cell)
    tables.entries.push_back({to_float(vec::scale(sky.radiance[cell], 1 / unit)), chosen_to[cell]});
  const Vec3d sun = has_sun ? vec::scale(sun_radiance(sky), 1 / unit) : Vec3d{0, 0, 0};
  tables.entries.push_back({to_float(sun), chosen_to.back()});
  return tables;
}

namespace {

/// An opening through which the sun alone comes stays among the emitters: it tells where the sun shines in.
constexpr double kLeastOfSun = 1e-6;

}  // namespace

std::vector<SkyEmitter> sky_emitters(const Scene& scene, const SceneSpace& space, const LightUnits& units) {
  std::vector<SkyEmitter> emitters;
  if (!scene.sky) return emitters;
  const double to_power = space.scale * space.scale / (std::numbers::pi * units.unit_radiance);
  const auto sum = [](const Vec3d& light) { return light[0] + light[1] + light[2]; };
  const auto all_directions = static_cast<float>(1 / std::numbers::pi);
  double sky_power = 0;
  double sun_power = 0;
  for (const SkyInlet& inlet : sky_inlets(scene, space)) {
    const protocol::SkyOpening& opening = inlet.opening;
    const Vec3d along = to_double(opening.along);
    const Vec3d across = to_double(opening.across);
    const double area = vec::length(vec::cross(along, across));
    const double cosine = std::max(0.0, -vec::dot(scene.sky->sun, to_double(opening.inwards)));
    const double sun = sum(scene.sky->sun_irradiance) * cosine * area / (space.scale * space.scale) * to_power;
    const double sky = std::max(0.0, sum(inlet.flux) * to_power - sun);
    sun_power += sun;
    sky_power += sky;
    if (scene.sky->openings.empty()) continue;
    const auto point = [&](double u, double v) {
      return to_float(vec::add(to_double(opening.corner), vec::add(vec::scale(along, u), vec::scale(across, v))));
    };
    const auto half_area = static_cast<float>(area / 2 / std::numbers::pi);
    for (const auto& corners :
         {std::array{point(0, 0), point(1, 0), point(1, 1)}, std::array{point(0, 0), point(1, 1), point(0, 1)}})
      emitters.push_back({{corners, {}, half_area, 0, protocol::kSkyTarget, protocol::kSkyThroughOpening},
                          std::max(sky, kLeastOfSun * sun) / 2});
  }
  if (scene.sky->openings.empty() && sky_power > 0)
    emitters.push_back({{{}, {}, all_directions, 0, protocol::kSkyTarget, protocol::kSkyAround}, sky_power});
  if (sun_power > 0) emitters.push_back({{{}, {}, all_directions, 0, protocol::kSkyTarget, protocol::kSkySun}, 0});
  return emitters;
}

}  // namespace torolux
