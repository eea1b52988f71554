// SPDX-License-Identifier: MIT
// The brightest channel of all emitted flux decides the quantum, the greatest radiance the unit. Emitters get chances
// by their flux, in whole 2^-32; radiances out of range are refused.
#include "host_tools/layout/light_units.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "emulator/errors.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/layout/lamp_tables.hpp"
#include "host_tools/layout/sky_tables.hpp"
#include "host_tools/scene/sky.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

LightUnits light_units(const Scene& scene, const Mesh& mesh, bool two_sided_lights) {
  LightUnits units;
  units.two_sided_lights = two_sided_lights;
  units.unit_radiance = 0;
  const std::vector<double> brightest = brightest_seen(scene);
  Vec3d emitted{0, 0, 0};
  for (const MeshTriangle& triangle : mesh.triangles) {
    const SceneMaterial& material = scene.materials[triangle.material];
    if (!emits(material)) continue;
    const bool measured = material.lamp != kNoMeasuredLamp;
    const double seen = measured ? brightest[material.lamp] : 1;
    for (const double radiance : material.emission)
      units.unit_radiance = std::max(units.unit_radiance, radiance * seen);
    const double area = triangle.area * (two_sided_lights && !measured ? 2 : 1);
    emitted = vec::add(emitted, vec::scale(material.emission, std::numbers::pi * area));
  }
  if (scene.sky) units.unit_radiance = std::max(units.unit_radiance, greatest_sky_radiance(*scene.sky));
  for (const SkyInlet& inlet : sky_inlets(scene, mesh.space)) emitted = vec::add(emitted, inlet.flux);
  const double greatest = std::max({emitted[0], emitted[1], emitted[2]});
  if (!(greatest > 0)) {
    std::string why = "scene '" + scene.name + "' has no light: no diffuse surface emits (Ke), and there is no sky";
    for (const std::string& note : mesh.notes) why += "\n  " + note;
    throw InputError(why);
  }
  units.watts_per_quantum = greatest / kEmittedQuanta;
  // The machine's floats must hold radiances and their reciprocals.
  if (!std::isfinite(greatest) || !(units.watts_per_quantum > 1e-300) || !(units.unit_radiance > 1e-30) ||
      !(units.unit_radiance < 1e30)) {
    throw InputError("scene '" + scene.name + "' emits " + std::to_string(greatest) + " W at up to " +
                     std::to_string(units.unit_radiance) + " W/(m^2 sr): radiances of 1e-30 to 1e30 are allowed");
  }
  return units;
}

float pixel_scale(const Mesh& mesh, const LightUnits& units) {
  // With reflectances below 0.99 a surface shows at most 100 units, 2^47 of the least quanta, far from the 2^63 at
  // which the frame buffer's integers end. The light of small emitters is weak against their own radiance: more quanta
  // do no harm there. A sample adds 2^56 quanta at most (to_quanta): 16 units of the finest, more than any
  // surface shows that a lamp lights.
  constexpr int least = 40;
  constexpr int most = 52;
  constexpr int wanted = 20;
  double area = 0;
  for (const MeshTriangle& triangle : mesh.triangles) area += triangle.area;
  const double shown = units.watts_per_quantum * kEmittedQuanta / (std::numbers::pi * area * units.unit_radiance);
  if (!std::isnormal(shown)) return std::ldexp(1.0F, most);  // so little that doubles lose it
  return std::ldexp(1.0F, std::clamp(wanted - std::ilogb(shown), least, most));
}

protocol::Flux patch_emission(const Scene& scene, const MeshPatch& patch, std::uint32_t side, const LightUnits& units) {
  const Vec3d emission = emission_of(scene, scene.materials[patch.material], side, units.two_sided_lights);
  protocol::Flux flux{};
  for (std::size_t c = 0; c < 3; ++c) {
    flux[c] = std::llround(std::numbers::pi * emission[c] * patch.area / units.watts_per_quantum);
  }
  return flux;
}

std::vector<protocol::Emitter> emitters(const Scene& scene, const Mesh& mesh, const LightUnits& units) {
  std::vector<protocol::Emitter> all;
  std::vector<double> flux;
  double sum = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    const MeshTriangle& triangle = mesh.triangles[t];
    const SceneMaterial& material = scene.materials[triangle.material];
    if (!emits(material)) continue;
    const Vec3d radiance = vec::scale(material.emission, 1 / units.unit_radiance);
    const double area = triangle.area * mesh.space.scale * mesh.space.scale;
    all.push_back({triangle.corner, to_float(radiance), static_cast<float>(area / std::numbers::pi), 0, t,
                   units.two_sided_lights ? 1U : 0U, material.lamp});
    flux.push_back(area * (radiance[0] + radiance[1] + radiance[2]));
    sum += flux.back();
  }
  for (const SkyEmitter& sky : sky_emitters(scene, mesh.space, units)) {
    all.push_back(sky.emitter);
    flux.push_back(sky.power);
    sum += sky.power;
  }
  std::optional<protocol::Emitter> sun;
  if (!all.empty() && all.back().polygon == protocol::kSkyTarget && all.back().both_sides == protocol::kSkySun) {
    sun = all.back();
    sun->chosen_to = 0xFFFF'FFFFU;
    all.pop_back();
  }
  // The chance that counts is the one that whole numbers of 2^-32 give it. The sun keeps the last of them.
  const std::uint64_t one = (std::uint64_t{1} << 32U) - (sun ? 1U : 0U);
  double until = 0;
  std::uint64_t before = 0;
  std::vector<protocol::Emitter> chosen;
  for (std::size_t i = 0; i < all.size(); ++i) {
    until += flux[i];
    const auto next =
        i + 1 == all.size() ? one : static_cast<std::uint64_t>(std::ldexp(std::min(until / sum, 1.0), 32));
    if (next <= before) continue;  // emits less than 2^-32 of all light
    const double chance = std::ldexp(static_cast<double>(next - before), -32);
    all[i].area_over_chance = static_cast<float>(all[i].area_over_chance / chance);
    all[i].chosen_to = static_cast<std::uint32_t>(next - 1);
    chosen.push_back(all[i]);
    before = next;
  }
  if (sun) chosen.push_back(*sun);
  return chosen;
}

namespace {

static_assert(kNoMeasuredLamp == protocol::kNoLamp);

/// What a sampled direction's share of the lobe weighs, but for its cosine; see firmware/pe/glossy.hpp.
void set_lobe(const SceneMaterial& material, protocol::Material& machine) {
  machine.kind = protocol::MaterialKind::glossy;
  const Vec3d weight = vec::scale(material.specular, (material.exponent + 2) / (material.exponent + 1));
  const double chance = std::min(1.0, vec::largest(weight));
  machine.specular = to_float(weight);
  machine.lobe_power = static_cast<float>(1 / (material.exponent + 1));
  machine.lobe_chance = static_cast<float>(chance);
  for (std::size_t c = 0; c < 3; ++c) {
    machine.specular_fraction[c] = static_cast<protocol::Fraction>(std::llround(std::ldexp(weight[c] / chance, 32)));
  }
}

}  // namespace

protocol::Material machine_material(const SceneMaterial& material, const LightUnits& units) {
  protocol::Material machine{};
  const auto set = [](const Vec3d& from, protocol::Vec3f& to, std::array<protocol::Fraction, 3>& fraction) {
    to = to_float(from);
    for (std::size_t c = 0; c < 3; ++c) fraction[c] = protocol::to_fraction(from[c]);
  };
  machine.refractive_index = 1;
  machine.texture = protocol::kNoTexture;
  switch (material.kind) {
    case SurfaceKind::diffuse:
      machine.kind = protocol::MaterialKind::diffuse;
      machine.diffuse = to_float(material.diffuse);
      machine.emission = to_float(vec::scale(material.emission, 1 / units.unit_radiance));
      machine.lamp = material.lamp;
      machine.emits_from_back = units.two_sided_lights && emits(material) ? 1 : 0;
      if (is_glossy(material)) set_lobe(material, machine);
      break;
    case SurfaceKind::mirror:
      machine.kind = protocol::MaterialKind::mirror;
      set(material.specular, machine.specular, machine.specular_fraction);
      break;
    case SurfaceKind::glass:
      machine.kind = material.thin ? protocol::MaterialKind::pane : protocol::MaterialKind::glass;
      machine.refractive_index = static_cast<float>(material.refractive_index);
      set(material.transmittance, machine.transmittance, machine.transmittance_fraction);
      break;
  }
  return machine;
}

}  // namespace torolux
