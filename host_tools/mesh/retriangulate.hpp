// SPDX-License-Identifier: MIT
// A scene's triangles enter; leave others, the same surface: flat regions are cut anew, whatever way the file cuts
// them.
#pragma once

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Regions with points that they do not need are cut into the fewest triangles that their corners allow (Delaunay).
/// What needs no change stays as it is, in its order. Of the scene, positions, texture points and triangles are used.
void retriangulate(Scene& scene);

}  // namespace torolux
