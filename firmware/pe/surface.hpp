// SPDX-License-Identifier: MIT
// What a hit says about its surface: normals, the element that it falls on, the interpolated light that leaves it.
#pragma once

#include <cstdint>

#include "firmware/pe/scene.hpp"
#include "firmware/pe/vectors.hpp"
#include "firmware/protocol/stores.hpp"
#include "firmware/protocol/triangle_grid.hpp"

namespace torolux::pe {

struct Hit;

/// Unit length, towards the front. Edges are normalised first, so that small triangles do not underflow.
inline glm::vec3 unit_normal(const protocol::Polygon& polygon) {
  const glm::vec3 a = to_vector(polygon.corner[0]);
  const glm::vec3 along = glm::normalize(to_vector(polygon.corner[1]) - a);
  return glm::normalize(glm::cross(along, glm::normalize(to_vector(polygon.corner[2]) - a)));
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

/// Irradiance / pi at a hit, interpolated over the lattice of the side that was hit; zero where it has none.
glm::vec3 interpolated_irradiance(const Scene& scene, const protocol::Polygon& polygon, const Hit& hit);

/// The three lattice vertices around a point and their weights, which add up to one.
struct LatticeWeights {
  std::uint32_t index[3];
  float weight[3];
};
inline LatticeWeights lattice_weights(float b1, float b2, std::uint32_t level) {
  const auto n = static_cast<std::int32_t>(1U << level);
  const float x = b1 * static_cast<float>(n);
  const float y = b2 * static_cast<float>(n);
  const auto below = [](float value, std::int32_t most) -> std::int32_t {  // rounding may leave the triangle a little
    if (!(value > 0.0F)) return 0;
    return value < static_cast<float>(most) ? static_cast<std::int32_t>(value) : most;
  };
  const std::int32_t i = below(x, n - 1);
  const std::int32_t j = below(y, n - 1 - i);
  const float fx = x - static_cast<float>(i);
  const float fy = y - static_cast<float>(j);
  const auto ui = static_cast<std::uint32_t>(i);
  const auto uj = static_cast<std::uint32_t>(j);
  const std::uint32_t right = protocol::lattice_index(ui + 1U, uj, level);
  const std::uint32_t up = protocol::lattice_index(ui, uj + 1U, level);
  if (fx + fy > 1.0F && i + j < n - 1) {
    return {{protocol::lattice_index(ui + 1U, uj + 1U, level), up, right}, {(fx + fy) - 1.0F, 1.0F - fx, 1.0F - fy}};
  }
  return {{protocol::lattice_index(ui, uj, level), right, up}, {(1.0F - fx) - fy, fx, fy}};
}

}  // namespace torolux::pe
