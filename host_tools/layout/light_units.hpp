// SPDX-License-Identifier: MIT
// Scene and mesh enter; the units in which the machine counts light leave, and materials and emitters in them.
#pragma once

#include <cstdint>
#include <vector>

#include "firmware/protocol/stores.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Quanta of the greatest channel of all that is emitted.
inline constexpr double kEmittedQuanta = 0x1p48;

struct LightUnits {
  double unit_radiance = 1;      ///< greatest emitted radiance of all channels [W/(m^2 sr)]
  double watts_per_quantum = 1;  ///< greatest channel's emitted flux / kEmittedQuanta
  bool two_sided_lights = false;
};

/// Throws InputError: nothing emits, or the emitted flux is not a finite number.
LightUnits light_units(const Scene& scene, const Mesh& mesh, bool two_sided_lights);

/// Quanta of a pixel for one unit of radiance, a power of two: so many that surfaces show at least 2^20 of them on
/// average, however small the emitters are against the scene, as far as 64 bits can hold what the brightest shows.
float pixel_scale(const Mesh& mesh, const LightUnits& units);

/// Emitted flux of one side (0 front, 1 back) of one patch of the triangle, pi * Ke * area, in quanta, rounded.
protocol::Flux patch_emission(const Scene& scene, const MeshPatch& patch, std::uint32_t side, const LightUnits& units);

/// All emitters, chosen by the flux that they emit. In the order of the mesh.
std::vector<protocol::Emitter> emitters(const Scene& scene, const Mesh& mesh, const LightUnits& units);

/// Without its texture, whose number depends on the PE.
protocol::Material machine_material(const SceneMaterial& material, const LightUnits& units);

}  // namespace torolux
