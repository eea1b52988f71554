// SPDX-License-Identifier: MIT
// Rays against triangles (Moeller and Trumbore 1997).
#include "host_tools/scene/ray_cast.hpp"

#include "host_tools/scene/vec.hpp"

namespace torolux {

std::optional<SceneHit> cast_ray(const Scene& scene, const Vec3d& origin, const Vec3d& direction,
                                 std::uint32_t without) {
  std::optional<SceneHit> nearest;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (t == without) continue;
    const auto& p = scene.triangles[t].position;
    const Vec3d& a = scene.positions[p[0]];
    const Vec3d e1 = vec::subtract(scene.positions[p[1]], a);
    const Vec3d e2 = vec::subtract(scene.positions[p[2]], a);
    const Vec3d cross = vec::cross(direction, e2);
    const double determinant = vec::dot(e1, cross);
    if (determinant == 0) continue;
    const Vec3d from = vec::subtract(origin, a);
    const double u = vec::dot(from, cross) / determinant;
    const Vec3d across = vec::cross(from, e1);
    const double v = vec::dot(direction, across) / determinant;
    const double distance = vec::dot(e2, across) / determinant;
    if (u >= 0 && v >= 0 && u + v <= 1 && distance > 0 && (!nearest || distance < nearest->distance))
      nearest = SceneHit{t, distance, determinant > 0};
  }
  return nearest;
}

Vec3d front_normal(const Scene& scene, std::uint32_t triangle) {
  const auto& [a, b, c] = scene.triangles[triangle].position;
  const Vec3d& corner = scene.positions[a];
  return vec::unit(vec::cross(vec::subtract(scene.positions[b], corner), vec::subtract(scene.positions[c], corner)));
}

}  // namespace torolux
