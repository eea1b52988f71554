// SPDX-License-Identifier: MIT
// Corners, quadrilaterals and boxes enter one by one; a Scene leaves in which equal positions are one, as in a loaded
// scene.
#include "tests/unit/host_tools/test_scenes.hpp"

#include <algorithm>

namespace torolux::test {

std::uint32_t SceneBuilder::material(const Vec3d& diffuse, const Vec3d& emission) {
  SceneMaterial material;
  material.name = "m" + std::to_string(scene.materials.size());
  material.diffuse = diffuse;
  material.emission = emission;
  scene.materials.push_back(material);
  return static_cast<std::uint32_t>(scene.materials.size() - 1);
}

std::uint32_t SceneBuilder::glass() {
  const std::uint32_t index = material({0, 0, 0});
  scene.materials[index].kind = SurfaceKind::glass;
  return index;
}

std::uint32_t SceneBuilder::position(const Vec3d& at) {
  const auto found = std::find(scene.positions.begin(), scene.positions.end(), at);
  if (found != scene.positions.end()) return static_cast<std::uint32_t>(found - scene.positions.begin());
  scene.positions.push_back(at);
  return static_cast<std::uint32_t>(scene.positions.size() - 1);
}

void SceneBuilder::triangle(std::uint32_t material, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  scene.triangles.push_back({{position(a), position(b), position(c)}, {kNoNormal, kNoNormal, kNoNormal}, material});
}

void SceneBuilder::quad(std::uint32_t material, const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  triangle(material, a, b, c);
  triangle(material, a, c, d);
}

void SceneBuilder::box(std::uint32_t material, const Vec3d& low, const Vec3d& high, bool inwards) {
  const auto at = [&](int x, int y, int z) {
    return Vec3d{x ? high[0] : low[0], y ? high[1] : low[1], z ? high[2] : low[2]};
  };
  const auto face = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
    if (inwards) {
      quad(material, a, d, c, b);
    } else {
      quad(material, a, b, c, d);
    }
  };
  face(at(0, 0, 0), at(0, 0, 1), at(0, 1, 1), at(0, 1, 0));
  face(at(1, 0, 0), at(1, 1, 0), at(1, 1, 1), at(1, 0, 1));
  face(at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1));
  face(at(0, 1, 0), at(0, 1, 1), at(1, 1, 1), at(1, 1, 0));
  face(at(0, 0, 0), at(0, 1, 0), at(1, 1, 0), at(1, 0, 0));
  face(at(0, 0, 1), at(1, 0, 1), at(1, 1, 1), at(0, 1, 1));
}

Scene room_with_box() {
  SceneBuilder builder;
  builder.scene.name = "room";
  const std::uint32_t wall = builder.material({0.7, 0.6, 0.5});
  const std::uint32_t lamp = builder.material({0, 0, 0}, {17, 12, 4});
  builder.box(wall, {0, 0, 0}, {1, 1, 1}, true);
  builder.quad(lamp, {0.3, 0.9, 0.3}, {0.7, 0.9, 0.3}, {0.7, 0.9, 0.7}, {0.3, 0.9, 0.7});
  builder.box(wall, {0.2, 0.1, 0.2}, {0.5, 0.5, 0.5});
  return builder.scene;
}

Scene finely_tessellated_floor() {
  SceneBuilder builder;
  const std::uint32_t white = builder.material({0.5, 0.5, 0.5});
  const auto at = [](int i, int j) {
    const double x = i / 20.0;
    return Vec3d{x, j / 20.0, 0.2 * x * x + 0.001 * (j % 2)};  // nowhere flat
  };
  for (int i = 0; i < 20; ++i) {
    for (int j = 0; j < 20; ++j) builder.quad(white, at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
  }
  builder.triangle(builder.material({0, 0, 0}, {1, 1, 1}), {0, 0, 2}, {0, 1, 2}, {1, 1, 2});
  return builder.scene;
}

}  // namespace torolux::test
