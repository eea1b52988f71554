// SPDX-License-Identifier: MIT
// Scene, settings and machine enter; all that must be there before a machine is started leaves: mesh, placements,
// units, parameters, memory.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "emulator/engines/image/image.hpp"
#include "host_tools/layout/copies.hpp"
#include "host_tools/layout/light_units.hpp"
#include "host_tools/layout/stage_layout.hpp"
#include "host_tools/settings/machine_choice.hpp"
#include "host_tools/settings/quality.hpp"

namespace torolux {

struct RenderSetup {
  Mesh mesh;
  LightUnits units;
  bool load_together = false;  ///< what all PEs have in common is broadcast
  bool points_travel = false;  ///< RadiositySettings::points_travel
  Placement placement;         ///< radiosity stage
  Placement ray_placement;     ///< ray tracing stage
  StageCopies radiosity_copies, ray_tracing_copies;
  StageParameters parameters;
  MemoryMap map;
  MemoryNeed need;
  std::optional<std::uint32_t> memory;  ///< absent: does not fit
  std::uint64_t credits = 0;            ///< W
  std::vector<std::string> notes;

  /// Scene's radiance for one quantum of a pixel.
  double radiance_per_quantum() const { return units.unit_radiance / double{parameters.pixel_scale}; }
  const Placement& placement_of(protocol::Stage stage) const {
    return stage == protocol::Stage::radiosity ? placement : ray_placement;
  }
};

/// What the mesh is made of, and made the same again. splits: of elements, ascending.
MeshChoice mesh_choice(const Quality& quality, const std::vector<Split>& splits);

/// splits: of elements, ascending. Throws UsageError (settings out of range) and InputError (no surface, no light, too
/// many elements). camera: what it sees most is copied to all PEs.
RenderSetup make_setup(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                       const Image& image, const std::vector<Split>& splits = {});

/// The settings of a draft, which is quick and rough.
Quality draft_of(Quality quality);
/// Refinement takes so many rounds, each on the mesh that the one before asked for: so edges of light are followed.
inline constexpr unsigned kDraftRounds = 2;
/// Drafts of all rounds: two of each, which differ by chance, so that noise is told from light.
inline constexpr unsigned kDrafts = 2 * kDraftRounds;

/// 32 bits of the user's seed.
std::uint32_t machine_seed(std::uint64_t seed);

}  // namespace torolux
