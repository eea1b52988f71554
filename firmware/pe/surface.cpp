// SPDX-License-Identifier: MIT
// What a hit says about its surface. Enters: the hit's weights; leaves: a normal, or light.
#include "firmware/pe/surface.hpp"

#include "firmware/pe/traverse.hpp"

namespace torolux::pe {

glm::vec3 shading_normal(const Scene& scene, const protocol::Polygon& polygon, const Hit& hit) {
  if (polygon.normals == protocol::kNoPolygon) return unit_normal(polygon);
  const protocol::Vec3f* corner = &scene.normals[polygon.normals];
  return glm::normalize(to_vector(corner[0]) * ((1.0F - hit.b1) - hit.b2) + to_vector(corner[1]) * hit.b1 +
                        to_vector(corner[2]) * hit.b2);
}

glm::vec3 interpolated_irradiance(const Scene& scene, const protocol::Polygon& polygon, const Hit& hit) {
  const std::uint8_t side = hit.front ? protocol::kFrontPresent : protocol::kBackPresent;
  if ((polygon.sides & side) == 0) return glm::vec3(0.0F);
  std::uint32_t first = polygon.surface;
  if (!hit.front && (polygon.sides & protocol::kFrontPresent) != 0) {
    first += protocol::lattice_size(polygon.element_level);
  }
  const LatticeWeights at = lattice_weights(hit.b1, hit.b2, polygon.element_level);
  glm::vec3 sum(0.0F);
  for (int i = 0; i < 3; ++i) {
    sum += to_vector(scene.lattice[first + at.index[i]].irradiance_over_pi) * at.weight[i];
  }
  return sum;
}

}  // namespace torolux::pe
