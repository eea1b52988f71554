// SPDX-License-Identifier: MIT
// Mirror, glass and panes: directions in, directions and the reflected fraction out.
#pragma once

#include "firmware/pe/vectors.hpp"

namespace torolux::pe {

/// What glass does with light: exact for a dielectric and unpolarised light (Fresnel; Born & Wolf, Principles of
/// Optics, 1.5).
struct Refraction {
  float reflectance;    ///< 0..1; 1: total internal reflection
  glm::vec3 direction;  ///< unit length; means nothing where reflectance is 1
};

/// direction: unit, towards the surface. normal: unit; either of its signs. geometric: of the flat polygon; the
/// reflected direction never goes through it, so near an outline that normals only pretend to round off it takes over.
glm::vec3 reflect(const glm::vec3& direction, const glm::vec3& geometric, const glm::vec3& shading);

/// eta: refractive index of the side that the light comes from over that of the other side.
Refraction refract(const glm::vec3& direction, const glm::vec3& geometric, const glm::vec3& shading, float eta);

/// What a pane does with light, both of its faces and all reflections between them taken together, without
/// interference (Born & Wolf, Principles of Optics, 7.6.1, with intensities for amplitudes). Parts of the light that
/// comes, by channel.
struct PaneParts {
  glm::vec3 reflected;
  glm::vec3 passed;   ///< unbent
  float reflectance;  ///< of the pane were it clear: 2 F / (1 + F); no channel of `reflected` is above it
};

/// transmittance: on one way between the faces. refractive_index: inside over outside. direction and normal: unit.
PaneParts pane_parts(const glm::vec3& direction, const glm::vec3& normal, float refractive_index,
                     const glm::vec3& transmittance);

}  // namespace torolux::pe
