// SPDX-License-Identifier: MIT
// What a path costs in a machine, found by following some on the host: mesh and placement in; subspaces entered,
// polygons met and hand-overs for each PE out. For predictions; no picture depends on it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/layout/placement.hpp"

namespace torolux {

/// Means per record.
struct PathWork {
  double arrivals = 0;  ///< at this PE, from another one
  double visits = 0;    ///< subspaces entered
  double polygons = 0;  ///< in the lists of those
  double deposits = 0;  ///< light that falls on a patch of this PE's
  double turns = 0;     ///< at mirror or glass
};

struct PathSample {
  std::vector<PathWork> of_pe;
  std::vector<std::array<double, 2>> hits;  ///< by triangle of the mesh: its front, its back
  double forwarded = 0;                     ///< deposits whose patch another PE owns
  double escaped = 0;                       ///< that leave the object space

  PathWork sum() const;
};

/// Light from emitters until its first diffuse surface, and from there to the next ones.
struct LightSample {
  PathSample emitted, reflected;
};

/// Follows `count` paths (> 0) from emitters over some diffuse surfaces; every start is cosine distributed, glass is
/// gone straight through. The same paths for the same mesh.
LightSample sample_light(const Scene& scene, const Mesh& mesh, const Placement& placement, std::uint32_t count);

}  // namespace torolux
