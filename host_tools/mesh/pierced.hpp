// SPDX-License-Identifier: MIT
// Pairs of neighbours on a smooth surface enter; which triangles another surface passes through leaves: a teapot's body
// where the spout enters it, or an uneven floor where something stands in it.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/scene/vec.hpp"

namespace torolux {

struct Mesh;

/// Two triangles, and the middle of the edge that they share [normalised].
struct SmoothEdge {
  std::array<std::uint32_t, 2> triangle;
  Vec3d middle;
};

/// By triangle of the mesh: whether another one, with no vertex in common with it or its neighbour, passes between its
/// centre and the middle of one of these edges. So two that lie on different sides of that surface never have an edge
/// in common unless one of them is pierced. In time that grows little faster than the triangles, unless many lie in one
/// place.
std::vector<bool> pierced_triangles(const Mesh& mesh, std::span<const SmoothEdge> edges);

}  // namespace torolux
