// SPDX-License-Identifier: MIT
// A scene's triangles enter; leave the same surface, where neighbours in a plane share whole edges.
#pragma once

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Where a triangle's edge ends within the edge of another that it continues (as flat regions have it), that one is cut
/// from there to the corner opposite. Quads around a window hang together so, though no edge of theirs is another's.
/// Of very many edges the longest are looked at. Of the scene, positions, normals, texture points and triangles are
/// used.
void split_edges_at_corners(Scene& scene);

}  // namespace torolux
