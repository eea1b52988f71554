// SPDX-License-Identifier: MIT
// What a hit says about its surface: normals, the element that it falls on, the interpolated light that leaves it.
#pragma once

#include <array>
#include <cstdint>

#include "firmware/pe/scene.hpp"
#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/stores.hpp"

namespace torolux::pe {

struct Hit;

/// Unit length, towards the front. Edges are normalised first, so that small triangles do not underflow.
inline glm::vec3 unit_normal(const std::array<protocol::Vec3f, 3>& corner) {
  const glm::vec3 a = to_vector(corner[0]);
  const glm::vec3 along = glm::normalize(to_vector(corner[1]) - a);
  return glm::normalize(glm::cross(along, glm::normalize(to_vector(corner[2]) - a)));
}
inline glm::vec3 unit_normal(const protocol::Polygon& polygon) {
  return unit_normal(polygon.corner);
}

/// Where light leaves a specular polygon that it met at `point`: drawn 2^-15 of the way to the polygon's centre, so
/// that rounding does not put a point at an edge beyond it, where the next wall could no longer be met.
inline glm::vec3 leaving_point(const protocol::Polygon& polygon, const glm::vec3& point) {
  const glm::vec3 centre =
      (to_vector(polygon.corner[0]) + to_vector(polygon.corner[1]) + to_vector(polygon.corner[2])) * (1.0F / 3.0F);
  return point + (centre - point) * 0x1p-15F;
}

/// The normal with which a specular surface reflects: interpolated where the polygon has corner normals.
glm::vec3 shading_normal(const Scene& scene, const protocol::Polygon& polygon, const Hit& hit);

/// Diffuse reflectance at a hit: the material's, times its texture.
glm::vec3 diffuse_reflectance(const Scene& scene, const protocol::Polygon& polygon, const Hit& hit);

/// What a PE has of the surface at a hit.
struct SurfaceLight {
  bool here;  ///< or another PE has it
  protocol::PeNumber keeper;
  std::uint32_t place;           ///< among what the keeper keeps
  glm::vec3 irradiance_over_pi;  ///< interpolated over the element of the side that was hit; zero where it has none
};
SurfaceLight light_at(const Scene& scene, protocol::PeNumber pe, const protocol::Polygon& polygon, const Hit& hit);

/// The place of the element under a hit in the polygon's grid (triangle_grid.hpp), or 0: the side has none. The surface
/// is here.
std::uint32_t element_code_at(const Scene& scene, const protocol::Polygon& polygon, const Hit& hit);

}  // namespace torolux::pe
