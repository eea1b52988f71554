// SPDX-License-Identifier: MIT
// What a hit says about its surface. Enters: the hit's weights; leaves: a normal, or light.
#include "firmware/pe/surface.hpp"

#include "firmware/pe/traverse.hpp"
#include "firmware/protocol/triangle_grid.hpp"

namespace torolux::pe {

glm::vec3 shading_normal(const Scene& scene, const protocol::Polygon& polygon, const Hit& hit) {
  if (polygon.normals == protocol::kNoPolygon) return unit_normal(polygon);
  const protocol::Vec3f* corner = &scene.normals[polygon.normals];
  return glm::normalize(to_vector(corner[0]) * ((1.0F - hit.b1) - hit.b2) + to_vector(corner[1]) * hit.b1 +
                        to_vector(corner[2]) * hit.b2);
}

glm::vec3 diffuse_reflectance(const Scene& scene, const protocol::Polygon& polygon, const Hit& hit) {
  const protocol::Material& material = scene.materials[polygon.material];
  if (material.texture == protocol::kNoTexture) return to_vector(material.diffuse);
  const protocol::Texture& texture = scene.textures[material.texture];
  const protocol::TexturePoint* corner = &scene.texture_points[polygon.texture_points];
  const auto between = [&hit](float a, float b, float c) { return (a + (b - a) * hit.b1) + (c - a) * hit.b2; };
  const protocol::TexturePoint at{between(corner[0].u, corner[1].u, corner[2].u),
                                  between(corner[0].v, corner[1].v, corner[2].v)};
  return to_vector(material.diffuse) *
         to_vector(texture_colour(&scene.texels[texture.first_texel], texture.width, texture.height, at));
}

glm::vec3 interpolated_irradiance(const Scene& scene, const protocol::Polygon& polygon, const Hit& hit) {
  const std::uint8_t side = hit.front ? protocol::kFrontPresent : protocol::kBackPresent;
  if ((polygon.sides & side) == 0) return glm::vec3(0.0F);
  protocol::Weights at{(1.0F - hit.b1) - hit.b2, hit.b1, hit.b2};
  std::uint32_t leaf = protocol::find_leaf(scene.nodes.data(), polygon.surface, at);
  if (!hit.front && (polygon.sides & protocol::kFrontPresent) != 0) ++leaf;
  const auto& corner = scene.lattice[leaf].irradiance_over_pi;
  return (to_vector(corner[0]) * at.b0 + to_vector(corner[1]) * at.b1) + to_vector(corner[2]) * at.b2;
}

}  // namespace torolux::pe
