// SPDX-License-Identifier: MIT
// Smooth surfaces: where radiance is interpolated across the edge that two triangles, and no third, share.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/mesh/mesh.hpp"

namespace torolux {

/// Triangles of one material, wound alike, whose normals differ by less than this pass radiance on smoothly.
inline constexpr double kSmoothCosine = 0.9396926207859084;  ///< 20 degrees

/// Edge e of a triangle runs from corner e to corner (e + 1) % 3. Corners or edges with the same node are one vertex
/// or one edge of a smooth surface. Only of triangles with sides; the others keep nodes of their own.
struct SmoothSurfaces {
  std::vector<std::array<std::uint32_t, 3>> corner_node;  ///< by triangle and corner, < 3 * triangles
  std::vector<std::array<std::uint32_t, 3>> edge_node;    ///< by triangle and edge, likewise
  std::vector<std::uint8_t> edge_level;  ///< by edge node: least element level of the triangles around it
};

SmoothSurfaces find_smooth_surfaces(const Mesh& mesh);

}  // namespace torolux
