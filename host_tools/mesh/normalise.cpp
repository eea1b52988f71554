// SPDX-License-Identifier: MIT
// The bounding box of triangles and openings, with a margin on every side, gives origin and scale. A scene without an
// extent is refused.
#include "host_tools/mesh/normalise.hpp"

#include <cmath>

#include "emulator/errors.hpp"
#include "host_tools/scene/sky.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

Vec3d SceneSpace::to_normalised(const Vec3d& position) const {
  return vec::scale(vec::subtract(position, origin), scale);
}

Vec3d SceneSpace::to_user(const Vec3d& normalised) const {
  Vec3d position{};
  for (std::size_t i = 0; i < 3; ++i) position[i] = normalised[i] / scale + origin[i];
  return position;
}

SceneSpace scene_space(const Scene& scene) {
  vec::Box box;
  for (const SceneTriangle& triangle : scene.triangles) {
    for (const std::uint32_t index : triangle.position) box.include(scene.positions[index]);
  }
  include_openings(scene, box);
  const Vec3d extent = box.extent();
  const double longest = vec::largest(extent);
  if (scene.triangles.empty() || !(longest > 0) || !std::isfinite(longest)) {
    throw InputError("scene '" + scene.name + "' has no surface with an area: at least one triangle is needed");
  }
  SceneSpace space;
  const double margin = longest * kSpaceMargin;
  space.scale = 1.0 / (longest + 2 * margin);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    space.origin[axis] = box.low[axis] - margin;
    space.size[axis] = (extent[axis] + 2 * margin) * space.scale;
  }
  return space;
}

protocol::Vec3f to_float(const Vec3d& v) {
  return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])};
}

Vec3d to_double(const protocol::Vec3f& v) {
  return {static_cast<double>(v[0]), static_cast<double>(v[1]), static_cast<double>(v[2])};
}

}  // namespace torolux
