// SPDX-License-Identifier: MIT
// Triangles enter; smooth surfaces leave: where radiance is interpolated across the edge that two triangles, and no
// third, share.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace torolux {

struct Mesh;

/// Triangles of one material, wound alike, whose normals differ by less than this pass radiance on smoothly.
inline constexpr double kSmoothCosine = 0.9396926207859084;  ///< 20 degrees
/// Where both are smaller than half an element they stand for something round.
inline constexpr double kSmoothCosineOfSmall = 0.7071067811865476;  ///< 45 degrees

/// Edge e of a triangle runs from corner e to corner (e + 1) % 3. Corners or edges with the same node are one vertex
/// or one edge of a smooth surface. Only of triangles with sides; the others keep nodes of their own.
struct SmoothSurfaces {
  std::vector<std::array<std::uint32_t, 3>> corner_node;  ///< by triangle and corner, < 3 * triangles
  std::vector<std::array<std::uint32_t, 3>> edge_node;    ///< by triangle and edge, likewise
  /// By triangle and edge: the triangle beyond it on the smooth surface, or kNoNeighbour.
  std::vector<std::array<std::uint32_t, 3>> neighbour;
};
inline constexpr std::uint32_t kNoNeighbour = 0xFFFF'FFFFU;

/// Whether a smooth surface of small triangles ends where another one passes through it, as large ones end at walls.
enum class Pierced : std::uint8_t { ends, goes_on };

/// small: by triangle, whether it is smaller than half an element.
SmoothSurfaces find_smooth_surfaces(const Mesh& mesh, const std::vector<bool>& small, Pierced pierced);

/// A point of a triangle's grid: weights of corners 1 and 2 in units of 2^-kMostLevels.
struct GridPoint {
  std::uint32_t i, j;
};

/// The corners of a triangle of the grid, named by its location code.
std::array<GridPoint, 3> grid_points(std::uint32_t code);

/// Names a vertex of a triangle's grid, the same for all triangles of a smooth surface that meet there.
std::uint64_t vertex_key(const Mesh& mesh, std::uint32_t triangle, const GridPoint& point);

}  // namespace torolux
