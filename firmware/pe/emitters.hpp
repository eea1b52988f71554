// SPDX-License-Identifier: MIT
// Shadow rays: a point of an emitter chosen by chance, and the light that comes from it if nothing is before it.
#pragma once

#include <cstdint>

#include "firmware/pe/scene.hpp"
#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/stratified.hpp"

namespace torolux::pe {

struct EmitterSample {
  glm::vec3 direction;           ///< unit length, towards the point
  glm::vec3 irradiance_over_pi;  ///< its mean over all samples is that of all emitters in sight
  std::uint32_t polygon;         ///< global number of the emitter
};

/// All channels together.
float brings(const EmitterSample& sample);

/// Of all emitters but the sun. numbers: uniform; triples that keep apart give emitters and points that do. normal:
/// unit length, of the side from which the surface is seen; geometric: likewise, of the polygon without its corner
/// normals. The scene has emitters. False: no light comes that way.
bool sample_emitter(const Scene& scene, const protocol::StratifiedTriple& numbers, const glm::vec3& point,
                    const glm::vec3& normal, const glm::vec3& geometric, EmitterSample& sample);

/// Likewise, of the sun. It has rays of its own: it outshines all else wherever nothing stands before it, so as one
/// emitter among others it would take nearly all rays, and hardly one would look for the sky in its shadows.
bool sample_sun(const Scene& scene, const protocol::StratifiedTriple& numbers, const glm::vec3& point,
                const glm::vec3& normal, const glm::vec3& geometric, EmitterSample& sample);

}  // namespace torolux::pe
