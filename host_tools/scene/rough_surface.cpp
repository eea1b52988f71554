// SPDX-License-Identifier: MIT
// Decides between a lobe, a mirror and a diffuse surface.
#include "host_tools/scene/rough_surface.hpp"

#include <algorithm>
#include <cmath>

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Less is not worth a lobe of its own.
constexpr double kLeastReflection = 0.005;

}  // namespace

double lobe_exponent(double roughness) {
  const double alpha = std::pow(std::clamp(roughness, kMirrorRoughness, 1.0), 2);
  return (1 / (alpha * alpha) - 1) / 2;  // facets turn light by twice their own angle: a quarter of theirs
}

void set_surface(const RoughSurface& surface, bool emits, SceneMaterial& material) {
  material.kind = SurfaceKind::diffuse;
  material.diffuse = surface.colour;
  material.specular = {0, 0, 0};
  if (surface.roughness >= kWideMetal) return;
  const double rest = 1 - surface.metallic;
  Vec3d reflection = vec::scale(surface.metal_colour, surface.metallic);
  Vec3d scattered{rest, rest, rest};
  if (surface.roughness < kWideReflection) {
    reflection = vec::add(reflection, vec::scale(surface.reflection, rest));
    scattered = vec::scale(vec::subtract({1, 1, 1}, surface.reflection), rest);
  }
  if (vec::largest(reflection) < kLeastReflection) return;
  material.diffuse = vec::times(surface.colour, scattered);
  material.specular = reflection;
  if (surface.roughness < kMirrorRoughness && vec::largest(material.diffuse) < kLeastReflection && !emits) {
    material.kind = SurfaceKind::mirror;
    material.diffuse = {0, 0, 0};
  } else {
    material.exponent = lobe_exponent(surface.roughness);
  }
}

}  // namespace torolux
