// SPDX-License-Identifier: MIT
// From reflectances, emission and the quality to the limits of the radiosity stage.
#include "host_tools/stages/radiosity_settings.hpp"
#include "firmware/protocol/messages.hpp"

#include <algorithm>

namespace torolux {

RadiositySettings radiosity_settings(const Scene& scene, const RenderSetup& setup, const Quality& quality) {
  const Mesh& mesh = setup.mesh;
  RadiositySettings settings;
  settings.pes = setup.placement.torus.pes();
  settings.credits = setup.credits;
  // Enough shooters to keep many PEs busy, few enough that each shoots what the others have just sent it.
  settings.shooters = std::clamp(static_cast<std::uint32_t>(mesh.patches.size()) / 12U, 8U, protocol::kMostShooters);
  settings.max_shots = quality.max_shots;
  double emitted = 0;
  for (const MeshPatch& patch : mesh.patches) {
    settings.reflectance.push_back({patch.reflectance[0], patch.reflectance[1], patch.reflectance[2]});
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (patch.side[side] == protocol::kNoSide) continue;
      for (const std::int64_t flux : patch_emission(scene, patch, side, setup.units)) {
        emitted += static_cast<double>(flux);
      }
    }
  }
  settings.shot_points = setup.parameters.shot_points;
  settings.emission_points = setup.parameters.emission_points;
  settings.points_per_quantum = setup.parameters.points_per_quantum;
  settings.points_travel = setup.points_travel;
  settings.emitted = emitted;
  settings.enough_unshot = static_cast<std::int64_t>(emitted * quality.unshot);
  // Where no side has more than this, emitted or reflected, all of them together have no more than `enough_unshot`.
  settings.least_unshot = settings.enough_unshot / (2 * std::max<std::int64_t>(1, mesh.patch_sides));
  return settings;
}

}  // namespace torolux
