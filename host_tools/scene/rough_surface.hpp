// SPDX-License-Identifier: MIT
// Reflectances and the roughness of a microfacet surface in; a diffuse, glossy or mirror material out.
#pragma once

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// At normal incidence. Roughness is perceptual, 0..1: GGX has alpha = roughness^2 (B. Walter et al., Microfacet models
/// for refraction through rough surfaces, EGSR 2007; B. Burley, Physically-based shading at Disney, 2012).
struct RoughSurface {
  Vec3d colour{0, 0, 0};               ///< of what is scattered below the surface, and of a metal
  double metallic = 0;                 ///< 0..1, the share of the surface that is bare metal
  Vec3d reflection{0.04, 0.04, 0.04};  ///< of the rest, at its surface
  double roughness = 1;
  Vec3d metal_colour{0, 0, 0};  ///< of the metal: a lobe has no texture
};

/// Narrower than the rays of a pixel can tell: a mirror, where nothing is diffuse.
inline constexpr double kMirrorRoughness = 0.1;
/// From here on a reflection that is not a metal's is so wide that the colour stands for both.
inline constexpr double kWideReflection = 0.7;
/// From here on a metal is diffuse: its lobe would have an exponent below 1 and lose what it sends below the surface.
inline constexpr double kWideMetal = 0.9;

/// Exponent of the lobe cos^n that is as wide as GGX of this roughness: 2 / alpha^2 - 2.
double lobe_exponent(double roughness);

/// Sets kind, diffuse, specular and exponent. emits: it has to be diffuse in kind.
void set_surface(const RoughSurface& surface, bool emits, SceneMaterial& material);

}  // namespace torolux
