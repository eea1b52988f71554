// SPDX-License-Identifier: MIT
// The reference radiosities of the Cornell box, an 8 x 8 grid of cells on every quadrilateral: tests/data in, cells and
// errors out.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "host_tools/scene/scene.hpp"

namespace torolux::test {

inline constexpr int kCells = 8;
inline constexpr std::size_t kCornellLight = 1;  ///< number of the light's quadrilateral

/// Triangles 2 q and 2 q + 1 of scenes/cornell_box are quadrilateral q.
struct ReferenceQuad {
  std::array<Vec3d, 4> corner;  ///< user units
  /// Radiance B / pi, mean of the cell, path traced; by cv, cu [W/(m^2 sr)].
  std::array<std::array<std::array<double, 3>, kCells>, kCells> radiance{};

  /// u from the first corner to the second, v from the first to the fourth, each 0..1; between the corners, linear.
  Vec3d point(double u, double v) const;
  /// Of its two triangles [user units^2].
  double area() const;
};

/// In the order of the scene file.
std::vector<ReferenceQuad> cornell_reference();

/// A place on a quadrilateral's triangles.
struct PlaceOnQuad {
  std::size_t triangle;
  double b1, b2;  ///< weights of corners 1 and 2
};
/// Where (u, v) lies in scenes/cornell_box, projected along the triangles' normals.
PlaceOnQuad place_on_quad(const Scene& scene, const ReferenceQuad& quad, std::size_t number, double u, double v);

/// Radiance of a cell: quadrilateral, cu, cv -> R G B.
using CellRadiance = std::function<std::array<double, 3>(std::size_t, int, int)>;

/// Area-weighted RMSE of all cells but the light's, relative to the area-weighted root mean square of the reference.
double cell_error(const std::vector<ReferenceQuad>& reference, const CellRadiance& radiance);

}  // namespace torolux::test
