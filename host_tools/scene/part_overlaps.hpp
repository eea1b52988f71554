// SPDX-License-Identifier: MIT
// A scene with surfaces that overlap in one plane in; the same with the lower ones cut out under the upper ones, out.
#pragma once

#include "host_tools/scene/notices.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Where surfaces overlap in one plane, on top is an emitter, then the smaller one, then the one that comes first: on
/// both sides. What lies under it is cut out, so that no two are left in one place; a surface that stands twice, its
/// fronts both ways, is one with two sides. Corners that come to lie on edges divide all triangles that have the edge:
/// what was closed stays closed. The same outline in both windings and two materials is a sheet with two colours: one
/// of them is moved two hundred-thousandths of the scene to its front. Of two emitters, or glass faces, back to back
/// each is moved by one. Scenes without overlaps stay as they are. place: of the scene.
void part_overlaps(Scene& scene, Notices& notices, const Place& place);

}  // namespace torolux
