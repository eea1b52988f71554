// SPDX-License-Identifier: MIT
// Glossy reflection: a lobe about the mirror direction, f = Ks (n + 2) / (2 pi) cos^n(alpha), alpha from that direction
// (E. Lafortune, Y. Willems, "Using the modified Phong reflectance model for physically based rendering", 1994).
#pragma once

#include <cstdint>

#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

/// A unit vector that falls as densely as (n + 1) / (2 pi) cos^n(alpha), alpha from `axis` (unit).
/// power: 1 / (n + 1); height, turn: uniform in [0, 1).
glm::vec3 around(const glm::vec3& axis, float power, float height, float turn);

/// A direction by which light goes on. Its weight is Material::specular times `cosine`: Ks on the average over all
/// directions where light comes straight from above, less where part of the lobe is below the surface.
struct LobeSample {
  glm::vec3 direction;  ///< unit length
  float cosine;         ///< to the polygon's normal; not above 0: below the surface, where light ends
};

/// in: unit, towards the surface; geometric, shading: unit normals of either sign, as `reflect` has them. height, turn:
/// uniform in [0, 1); pairs that keep apart give directions that do.
LobeSample sample_lobe(const protocol::Material& material, const glm::vec3& in, const glm::vec3& geometric,
                       const glm::vec3& shading, float height, float turn);

}  // namespace torolux::pe
