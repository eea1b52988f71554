// SPDX-License-Identifier: MIT
// A scene enters; the way from the user's units to the machine's leaves: to object space with its lowest corner at the
// origin and its longest edge 1.
#pragma once

#include "firmware/protocol/records.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// The object space is the bounding box of triangles and openings, grown on every side by kSpaceMargin of its longest
/// edge, so that no polygon lies in an outer face, where rounding could let a ray leave before it meets the polygon.
inline constexpr double kSpaceMargin = 1.0 / 1024;

struct SceneSpace {
  Vec3d origin{0, 0, 0};  ///< user position of the object space's lowest corner
  double scale = 1;       ///< normalised length of one user unit
  Vec3d size{1, 1, 1};    ///< of the object space, normalised; the longest is 1

  Vec3d to_normalised(const Vec3d& position) const;
  Vec3d to_user(const Vec3d& normalised) const;
};

/// Of all positions that triangles use, and of openings. Throws InputError where there is no triangle or no extent.
SceneSpace scene_space(const Scene& scene);

protocol::Vec3f to_float(const Vec3d& v);
Vec3d to_double(const protocol::Vec3f& v);

}  // namespace torolux
