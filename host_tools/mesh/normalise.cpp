// SPDX-License-Identifier: MIT
// The bounding box of triangles and openings, with a margin on every side, gives origin and scale. A scene without an
// extent is refused.
#include "host_tools/mesh/normalise.hpp"

#include <algorithm>
#include <limits>

#include "emulator/errors.hpp"
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
  constexpr double infinite = std::numeric_limits<double>::infinity();
  Vec3d low{infinite, infinite, infinite};
  Vec3d high{-infinite, -infinite, -infinite};
  const auto hold = [&low, &high](const Vec3d& at) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], at[axis]);
      high[axis] = std::max(high[axis], at[axis]);
    }
  };
  for (const SceneTriangle& triangle : scene.triangles) {
    for (const std::uint32_t index : triangle.position) hold(scene.positions[index]);
  }
  if (scene.sky && !scene.triangles.empty()) {
    for (const SkyQuad& opening : scene.sky->openings) {
      for (const Vec3d& near : {opening.corner, vec::add(opening.corner, opening.along)}) {
        hold(near);
        hold(vec::add(near, opening.across));
      }
    }
  }
  const Vec3d extent = vec::subtract(high, low);
  const double longest = std::max({extent[0], extent[1], extent[2]});
  if (scene.triangles.empty() || !(longest > 0) || !std::isfinite(longest)) {
    throw InputError("scene '" + scene.name + "' has no surface with an area: at least one triangle is needed");
  }
  SceneSpace space;
  const double margin = longest * kSpaceMargin;
  space.scale = 1.0 / (longest + 2 * margin);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    space.origin[axis] = low[axis] - margin;
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
