// SPDX-License-Identifier: MIT
// A ray against each triangle in turn.
#include "host_tools/scene/ray_cast.hpp"

#include "host_tools/scene/ray_triangle.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

std::optional<SceneHit> cast_ray(const Scene& scene, const Vec3d& origin, const Vec3d& direction,
                                 std::uint32_t without) {
  std::optional<SceneHit> nearest;
  for (std::uint32_t t = 0; t < scene.triangles.size(); ++t) {
    if (t == without) continue;
    const auto& p = scene.triangles[t].position;
    const auto hit =
        meet_plane(origin, direction, {scene.positions[p[0]], scene.positions[p[1]], scene.positions[p[2]]});
    if (hit && hit->inside() && hit->t > 0 && (!nearest || hit->t < nearest->distance))
      nearest = SceneHit{t, hit->t, hit->determinant > 0};
  }
  return nearest;
}

Vec3d front_normal(const Scene& scene, std::uint32_t triangle) {
  const auto& [a, b, c] = scene.triangles[triangle].position;
  const Vec3d& corner = scene.positions[a];
  return vec::unit(vec::cross(vec::subtract(scene.positions[b], corner), vec::subtract(scene.positions[c], corner)));
}

}  // namespace torolux
