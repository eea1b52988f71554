// SPDX-License-Identifier: MIT
// Rays against triangles, the innermost loop of a PE: how many rays in, a number that depends on every hit out.
#pragma once

#include <bit>
#include <cstdint>

#include "firmware/pe/intersect.hpp"
#include "firmware/pe/walk.hpp"

namespace torolux::test {

/// Rays of one run of the benchmark; each meets 64 triangles.
inline constexpr std::uint32_t kBenchRays = 100'000;

inline std::uint32_t cross_triangles(std::uint32_t rays) {
  static protocol::Polygon polygons[64];
  std::uint32_t state = 12345;
  const auto uniform = [&] {
    state = state * 1664525U + 1013904223U;  // Numerical Recipes' generator
    return static_cast<float>(state >> 8U) * 0x1p-24F;
  };
  for (protocol::Polygon& polygon : polygons) {
    for (auto& corner : polygon.corner) {
      for (auto& value : corner) value = uniform();
    }
  }
  std::uint32_t hits = 0;
  float sum = 0;
  for (std::uint32_t ray = 0; ray < rays; ++ray) {
    glm::vec3 origin;
    glm::vec3 direction;
    for (int axis = 0; axis < 3; ++axis) origin[axis] = uniform();
    for (int axis = 0; axis < 3; ++axis) direction[axis] = uniform() - 0.5F;
    const pe::Shear shear(origin, direction, pe::Inverse(direction));
    for (const protocol::Polygon& polygon : polygons) {
      pe::Crossing crossing;
      if (!pe::cross_triangle(shear, polygon, crossing)) continue;
      ++hits;
      sum += crossing.t;
    }
  }
  return hits ^ std::bit_cast<std::uint32_t>(sum);
}

}  // namespace torolux::test
