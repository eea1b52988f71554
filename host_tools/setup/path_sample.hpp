// SPDX-License-Identifier: MIT
// What light's paths cost in a machine, found by following some on the host: mesh and placement in; subspaces entered,
// polygons met and hand-overs for each PE out. For predictions; no picture depends on it.
#pragma once

#include "host_tools/setup/path_cost.hpp"

namespace torolux {

/// Light from emitters until it ends at a surface, and from where surfaces reflect it diffusely to the next ones. By a
/// glossy surface's lobe a path goes on.
struct LightSample {
  PathSample emitted, reflected;
};

/// Follows `count` paths (> 0) from emitters over some diffuse surfaces; every start is cosine distributed, glass is
/// gone straight through. The same paths for the same mesh. bounces: mirrors, glass and lobes on a path. heat: gets the
/// paths too, if given, as many records as the radiosity stage has for each path from an emitter.
LightSample sample_light(const Scene& scene, const Mesh& mesh, const Placement& placement, std::uint32_t bounces,
                         std::uint32_t count, Heat* heat = nullptr);

}  // namespace torolux
