// SPDX-License-Identifier: MIT
// Areas of triangles, by whether their materials are meant, over the area of all.
#include "host_tools/scene/surface_shares.hpp"

#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

template <class IsMeant>
double share_of_surface(const Scene& scene, IsMeant is_meant) {
  double all = 0;
  double meant = 0;
  for (const SceneTriangle& triangle : scene.triangles) {
    const auto& [a, b, c] = triangle.position;
    const Vec3d& corner = scene.positions[a];
    const double area =
        vec::length(vec::cross(vec::subtract(scene.positions[b], corner), vec::subtract(scene.positions[c], corner)));
    all += area;
    if (is_meant(scene.materials[triangle.material])) meant += area;
  }
  return all > 0 ? meant / all : 0;
}

}  // namespace

bool has_large_emitters(const Scene& scene) {
  return share_of_surface(scene, emits) > 0.125;
}

double turning_share(const Scene& scene) {
  return share_of_surface(scene, [](const SceneMaterial& material) {
    return is_glossy(material) || (material.kind != SurfaceKind::diffuse && !material.thin);
  });
}

}  // namespace torolux
