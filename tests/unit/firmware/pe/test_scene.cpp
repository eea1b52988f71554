// SPDX-License-Identifier: MIT
// Scenes for tests of the firmware.
#include "tests/unit/firmware/pe/test_scene.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "firmware/pe/vectors.hpp"

namespace torolux::test {
namespace {

using protocol::Vec3f;

Vec3f plus(const Vec3f& a, const Vec3f& b, float s) {
  return {a[0] + s * b[0], a[1] + s * b[1], a[2] + s * b[2]};
}

}  // namespace

std::array<std::uint32_t, 3> TestScene::cell_of(const std::array<double, 3>& point) const {
  std::array<std::uint32_t, 3> cell{};
  for (std::size_t a = 0; a < 3; ++a) {
    const float step = size[a] / static_cast<float>(cells[a]);
    while (cell[a] + 1 < cells[a] && static_cast<float>(point[a]) >= static_cast<float>(cell[a] + 1) * step) ++cell[a];
  }
  return cell;
}

float area_of(const std::array<Vec3f, 3>& corner) {
  const glm::vec3 a = pe::to_vector(corner[0]);
  return 0.5F * glm::length(glm::cross(pe::to_vector(corner[1]) - a, pe::to_vector(corner[2]) - a));
}

protocol::Material diffuse_material(float reflectance, float emission) {
  protocol::Material m{};
  m.kind = protocol::MaterialKind::diffuse;
  m.diffuse = {reflectance, reflectance, reflectance};
  m.emission = {emission, emission, emission};
  m.texture = protocol::kNoTexture;
  return m;
}
protocol::Material mirror_material(float reflectance) {
  protocol::Material m{};
  m.kind = protocol::MaterialKind::mirror;
  m.texture = protocol::kNoTexture;
  m.specular = {reflectance, reflectance, reflectance};
  m.specular_fraction.fill(protocol::to_fraction(static_cast<double>(reflectance)));
  return m;
}
protocol::Material glass_material(float refractive_index, float transmittance) {
  protocol::Material m{};
  m.kind = protocol::MaterialKind::glass;
  m.texture = protocol::kNoTexture;
  m.refractive_index = refractive_index;
  m.transmittance = {transmittance, transmittance, transmittance};
  m.transmittance_fraction.fill(protocol::to_fraction(static_cast<double>(transmittance)));
  return m;
}
protocol::Material pane_material(float refractive_index, float transmittance) {
  protocol::Material m = glass_material(refractive_index, transmittance);
  m.kind = protocol::MaterialKind::pane;
  return m;
}
protocol::Material glossy_material(float diffuse, float specular, float exponent) {
  protocol::Material m = diffuse_material(diffuse);
  m.kind = protocol::MaterialKind::glossy;
  const float weight = specular * (exponent + 2) / (exponent + 1);
  m.specular = {weight, weight, weight};
  m.lobe_power = 1 / (exponent + 1);
  m.lobe_chance = std::min(1.0F, weight);
  m.specular_fraction.fill(static_cast<protocol::Fraction>(static_cast<double>(weight / m.lobe_chance) * 0x1p32));
  return m;
}

void aim_at(TestScene& scene, std::uint16_t material) {
  for (std::uint32_t p = 0; p < scene.polygons.size(); ++p) {
    if (scene.polygons[p].material != material) continue;
    const auto& corner = scene.polygons[p].corner;
    scene.emitters.push_back({corner, scene.materials[material].emission, area_of(corner) / std::numbers::pi_v<float>,
                              0, p, scene.materials[material].emits_from_back});
  }
  const auto count = static_cast<std::uint32_t>(scene.emitters.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    scene.emitters[i].area_over_chance *= static_cast<float>(count);
    scene.emitters[i].chosen_to = i + 1 == count ? 0xFFFF'FFFFU : (i + 1) * (0xFFFF'FFFFU / count);
  }
}

void add_wall(TestScene& scene, const Vec3f& corner, const Vec3f& a, const Vec3f& b, std::uint32_t n,
              std::uint16_t material) {
  const auto at = [&](std::uint32_t i, std::uint32_t j) {
    const auto part = [n](std::uint32_t k) { return static_cast<float>(k) / static_cast<float>(n); };
    return plus(plus(corner, a, part(i)), b, part(j));
  };
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < n; ++i) {
      scene.polygons.push_back({{at(i, j), at(i + 1, j), at(i + 1, j + 1)}, material});
      scene.polygons.push_back({{at(i, j), at(i + 1, j + 1), at(i, j + 1)}, material});
    }
}

void add_room(TestScene& scene, const Vec3f& low, const Vec3f& high, std::uint32_t n, std::uint16_t material) {
  const float x = high[0] - low[0], y = high[1] - low[1], z = high[2] - low[2];
  add_wall(scene, low, {x, 0, 0}, {0, y, 0}, n, material);  // z low, front +z
  add_wall(scene, {low[0], low[1], high[2]}, {0, y, 0}, {x, 0, 0}, n, material);
  add_wall(scene, low, {0, y, 0}, {0, 0, z}, n, material);  // x low, front +x
  add_wall(scene, {high[0], low[1], low[2]}, {0, 0, z}, {0, y, 0}, n, material);
  add_wall(scene, low, {0, 0, z}, {x, 0, 0}, n, material);  // y low, front +y
  add_wall(scene, {low[0], high[1], low[2]}, {x, 0, 0}, {0, 0, z}, n, material);
}

void add_ball(TestScene& scene, const Vec3f& centre, float radius, std::uint32_t n, std::uint16_t material,
              bool front_outside) {
  const auto at = [&](std::uint32_t i, std::uint32_t j) -> Vec3f {
    const double theta = std::numbers::pi * j / n;
    const double phi = std::numbers::pi * (i % (2 * n)) / n;
    if (j == 0 || j == n) return {centre[0], centre[1], centre[2] + (j == 0 ? radius : -radius)};
    return {centre[0] + radius * static_cast<float>(std::sin(theta) * std::cos(phi)),
            centre[1] + radius * static_cast<float>(std::sin(theta) * std::sin(phi)),
            centre[2] + radius * static_cast<float>(std::cos(theta))};
  };
  const auto add = [&](const Vec3f& p, const Vec3f& q, const Vec3f& r) {
    scene.polygons.push_back({front_outside ? std::array{p, q, r} : std::array{p, r, q}, material});
  };
  for (std::uint32_t j = 0; j < n; ++j)
    for (std::uint32_t i = 0; i < 2 * n; ++i) {
      if (j > 0) add(at(i, j), at(i, j + 1), at(i + 1, j));
      if (j + 1 < n) add(at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
    }
}

}  // namespace torolux::test
