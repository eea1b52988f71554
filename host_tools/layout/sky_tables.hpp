// SPDX-License-Identifier: MIT
// The scene's sky enters; leaves: what PEs have of it, and the flux that comes in through each opening.
#pragma once

#include <vector>

#include "firmware/protocol/stores.hpp"
#include "host_tools/layout/light_units.hpp"
#include "host_tools/mesh/normalise.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// An opening, and the light that it lets in.
struct SkyInlet {
  protocol::SkyOpening opening{};
  Vec3d flux{0, 0, 0};  ///< [W]
  Vec3d all{0, 0, 0};   ///< area times radiance summed over all directions: `flux` were all cosines 1 [W]
};

/// As the scene names them; without, the six faces of the object space. Those through which nothing comes are left out.
std::vector<SkyInlet> sky_inlets(const Scene& scene, const SceneSpace& space);

struct SkyTables {
  protocol::SkyFrame frame{};
  std::vector<protocol::SkyEntry> entries;  ///< kSkyEntries, or none: no sky
};
SkyTables sky_tables(const Scene& scene, const LightUnits& units);

/// What shadow rays aim at, with the chance still to come.
struct SkyEmitter {
  protocol::Emitter emitter{};
  double power = 0;  ///< what comes in over pi [normalised area x unit of radiance, R + G + B]; of the sun 0: it has
                     ///< rays of its own
};
/// All directions; or where the scene names openings, the halves of each, so that no ray looks for the sky through
/// walls. Then the sun.
std::vector<SkyEmitter> sky_emitters(const Scene& scene, const SceneSpace& space, const LightUnits& units);

}  // namespace torolux
