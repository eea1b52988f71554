// SPDX-License-Identifier: MIT
// One value for each pixel, and weighted means of neighbours: a plane enters, a filtered one leaves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace torolux {

struct Plane {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<float> values;  ///< row 0 on top

  Plane() = default;
  Plane(std::uint32_t columns, std::uint32_t rows)
      : width(columns), height(rows), values(std::size_t{columns} * rows) {}
};

/// Weights of neighbours at distances -n..n, 2 n + 1 of them, that add up to 1: exp(-distance^2 / (2 sigma^2)).
/// sigma > 0 [pixels].
std::vector<double> gaussian_weights(double sigma, int n);

/// Each pixel becomes the sum of its neighbours', weighted by across[] in its row, then by down[] in its column; both
/// odd in number, the middle one the pixel's own. Beyond the edges lie the values of the edge. Not empty.
Plane filter(const Plane& plane, std::span<const double> across, std::span<const double> down);

/// Means of blocks of 2 x 2 pixels; those at the right and lower edges may have fewer. Not empty.
Plane halve(const Plane& plane);

}  // namespace torolux
