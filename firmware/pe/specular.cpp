// SPDX-License-Identifier: MIT
// Mirror, glass and panes: the law of reflection, Snell's law, Fresnel's equations.
#include "firmware/pe/specular.hpp"

#include <cmath>

namespace torolux::pe {
namespace {

/// The normal on the side that the light comes from.
glm::vec3 towards_light(const glm::vec3& normal, const glm::vec3& direction) {
  return glm::dot(direction, normal) > 0.0F ? -normal : normal;
}

glm::vec3 mirrored(const glm::vec3& direction, const glm::vec3& normal) {
  return glm::normalize(direction - normal * (2.0F * glm::dot(direction, normal)));
}

Refraction refracted(const glm::vec3& direction, const glm::vec3& normal, float eta) {
  const float cos_in = -glm::dot(direction, normal);
  const float sin2_out = eta * eta * (1.0F - cos_in * cos_in);
  if (!(sin2_out < 1.0F) || !(cos_in > 0.0F)) return {1.0F, direction};
  const float cos_out = std::sqrt(1.0F - (sin2_out > 0.0F ? sin2_out : 0.0F));
  const float perpendicular = (eta * cos_in - cos_out) / (eta * cos_in + cos_out);
  const float parallel = (cos_in - eta * cos_out) / (cos_in + eta * cos_out);
  return {0.5F * (perpendicular * perpendicular + parallel * parallel),
          glm::normalize(direction * eta + normal * (eta * cos_in - cos_out))};
}

}  // namespace

glm::vec3 reflect(const glm::vec3& direction, const glm::vec3& geometric, const glm::vec3& shading) {
  const glm::vec3 facing = towards_light(geometric, direction);
  const glm::vec3 out = mirrored(direction, shading);
  return glm::dot(out, facing) > 0.0F ? out : mirrored(direction, facing);
}

Refraction refract(const glm::vec3& direction, const glm::vec3& geometric, const glm::vec3& shading, float eta) {
  const glm::vec3 facing = towards_light(geometric, direction);
  glm::vec3 smooth = glm::dot(shading, facing) < 0.0F ? -shading : shading;
  if (!(glm::dot(direction, smooth) < 0.0F)) smooth = facing;
  const Refraction out = refracted(direction, smooth, eta);
  if (out.reflectance < 1.0F && !(glm::dot(out.direction, facing) < 0.0F)) return refracted(direction, facing, eta);
  return out;
}

PaneParts pane_parts(const glm::vec3& direction, const glm::vec3& normal, float refractive_index,
                     const glm::vec3& transmittance) {
  const float face = refracted(direction, towards_light(normal, direction), 1.0F / refractive_index).reflectance;
  if (!(face < 1.0F)) return {glm::vec3(1.0F), glm::vec3(0.0F), 1.0F};
  const float through = 1.0F - face;
  const glm::vec3 between = 1.0F / (1.0F - transmittance * transmittance * (face * face));
  return {face + transmittance * transmittance * (face * through * through) * between,
          transmittance * (through * through) * between, 2.0F * face / (1.0F + face)};
}

}  // namespace torolux::pe
