// SPDX-License-Identifier: MIT
// Triangles of a scene in; the flat surfaces they form, and which of them overlap in one plane, out.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

/// Of the scene's longest edge: what is nearer than this to a plane lies in it. A PE's floats tell 2^-24 apart.
inline constexpr double kSamePlane = 1e-6;

/// Triangles of one material that hang together by edges, wound alike, in one plane.
struct FlatSurface {
  std::vector<std::uint32_t> triangles;  ///< ascending
  Vec3d normal{0, 0, 0};                 ///< to the front, length 1
  vec::Box box;
  double area = 0;  ///< [scene units^2]
  bool emits = false;
  bool glass = false;  ///< is never laid over or under what is not: its faces part media
  bool solid = false;  ///< of a closed surface with its fronts outwards
};

/// In the order of their first triangles. size: the scene's longest edge.
std::vector<FlatSurface> flat_surfaces(const Scene& scene, double size);

/// Which of two lies on top, on both sides: an emitter, then the smaller one, then the one that comes first.
bool lies_on(const std::vector<FlatSurface>& surfaces, std::uint32_t upper, std::uint32_t lower);

struct PlanePairs {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;  ///< (upper, lower), ascending
  bool too_many = false;                                       ///< to look at: there may be more pairs
};

/// Those whose boxes overlap in one plane. Left out: glass with anything but glass, and what stands on another with a
/// solid's bottom: it is dark there, as it should be.
PlanePairs pairs_in_one_plane(const Scene& scene, const std::vector<FlatSurface>& surfaces, double size);

}  // namespace torolux
