// SPDX-License-Identifier: MIT
// What a hit says about its surface. Enters: the hit's weights; leaves: a normal, or light.
#include "firmware/pe/surface.hpp"

#include "firmware/pe/traverse.hpp"
#include "firmware/protocol/element_light.hpp"
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

namespace {

bool has_elements(const protocol::Polygon& polygon, const Hit& hit) {
  return (polygon.sides & (hit.front ? protocol::kFrontPresent : protocol::kBackPresent)) != 0;
}

protocol::Weights weights_of(const Hit& hit) {
  return {(1.0F - hit.b1) - hit.b2, hit.b1, hit.b2};
}

}  // namespace

SurfaceLight light_at(const Scene& scene, protocol::PeNumber pe, const protocol::Polygon& polygon, const Hit& hit) {
  SurfaceLight light{true, pe, 0, glm::vec3(0.0F)};
  if (!has_elements(polygon, hit)) return light;
  protocol::Weights at = weights_of(hit);
  std::uint32_t leaf = protocol::find_leaf(scene.nodes.data(), polygon.surface, at);
  if ((leaf & protocol::kKept) != 0) {
    light.keeper = protocol::keeper_of(leaf);
    light.place = protocol::kept_place(leaf);
    light.here = light.keeper == pe;
    if (!light.here) return light;
    leaf = protocol::find_leaf(scene.nodes.data(), scene.kept[light.place].node, at);
  }
  if (!hit.front && (polygon.sides & protocol::kFrontPresent) != 0) ++leaf;
  const protocol::CornerIrradiance& corners = scene.irradiance[leaf];
  const protocol::Weights by = protocol::light_weights(protocol::concave_corners(corners), at);
  const auto corner = [&corners](std::size_t c) { return to_vector(protocol::irradiance_at(corners, c)); };
  light.irradiance_over_pi = (corner(0) * by.b0 + corner(1) * by.b1) + corner(2) * by.b2;
  return light;
}

std::uint32_t element_code_at(const Scene& scene, const protocol::Polygon& polygon, const Hit& hit) {
  if (!has_elements(polygon, hit)) return 0;
  protocol::Weights at = weights_of(hit);
  std::uint32_t code = 1;
  const std::uint32_t leaf = protocol::find_leaf(scene.nodes.data(), polygon.surface, at, code);
  if ((leaf & protocol::kKept) != 0) {
    protocol::find_leaf(scene.nodes.data(), scene.kept[protocol::kept_place(leaf)].node, at, code);
  }
  return code;
}

}  // namespace torolux::pe
