// SPDX-License-Identifier: MIT
// A scene's triangles enter; leave as many others, the same surface: flat regions are cut anew, whatever way the file
// cuts them, so that no large triangle is thinner than the region's outline asks for.
#pragma once

#include <limits>

#include "host_tools/scene/scene.hpp"

namespace torolux {

inline constexpr double kAnyLength = std::numeric_limits<double>::infinity();

/// Regions are cut into the fewest triangles that their corners allow (Delaunay); where one with an edge longer than
/// `least` [user units] would have an angle below some 20 degrees, into more. What needs no change stays as it is, in
/// its order. Of the scene, positions, normals, texture points and triangles are used.
void retriangulate(Scene& scene, double least);

}  // namespace torolux
