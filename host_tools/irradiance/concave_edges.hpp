// SPDX-License-Identifier: MIT
// The vertices of a side enter; those on concave edges leave, where another surface rises before this one, and what the
// shape of light there (firmware/protocol/element_light.hpp) makes of means and slopes.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "firmware/protocol/element_light.hpp"
#include "host_tools/irradiance/surface_vertices.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {

class ConcaveEdges {
 public:
  /// vertices: outlives this. follows: by facet, whether light over it is shown by its corners alone; no vertex of
  /// another counts as lying on a concave edge.
  ConcaveEdges(const Mesh& mesh, const SurfaceVertices& vertices, std::uint32_t side, const std::vector<bool>& follows);

  bool has(std::uint32_t vertex) const { return on_edge_[vertex]; }
  protocol::ConcaveCorners corners(std::uint32_t facet) const;

 private:
  const SurfaceVertices& vertices_;
  std::vector<bool> on_edge_;        ///< by vertex
  std::vector<std::uint8_t> sides_;  ///< by facet; bit c: the side from corner c to the next lies on a concave edge
};

/// What each corner's light is of the mean over an element: protocol::light_weights, integrated.
constexpr std::array<double, 3> mean_weights(protocol::ConcaveCorners concave) {
  const int count = std::popcount(concave & 0b111U);
  if (count == 0 || count == 3) return {1.0 / 3, 1.0 / 3, 1.0 / 3};
  const bool inside = (concave & protocol::kSideInside) != 0;
  const double of_others = count == 1 ? 2.0 / 5 : inside ? 11.0 / 27 : 8.0 / 15;
  const double on_edge = (1 - (3 - count) * of_others) / count;
  std::array<double, 3> weights{};
  for (std::size_t c = 0; c < 3; ++c) weights[c] = (concave >> c & 1U) != 0 ? on_edge : of_others;
  return weights;
}

/// How fast light rises where an element ends, at the side opposite to `corner`, in parts of what it would if it rose
/// evenly from there.
constexpr double slope_at_side(protocol::ConcaveCorners concave, std::size_t corner) {
  return concave == 1U << corner ? 0.5 : 1;
}

/// Where between two vertices light is as far along as `along`, 0..1, of the way: as light_weights has it on an edge.
double light_along(bool from_concave, bool to_concave, double along);

}  // namespace torolux
