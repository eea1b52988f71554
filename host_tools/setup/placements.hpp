// SPDX-License-Identifier: MIT
// Where everything stands in each stage: mesh, settings and machine enter; grid, placements, copies and memory leave.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "host_tools/layout/copies.hpp"
#include "host_tools/layout/light_units.hpp"
#include "host_tools/layout/stage_layout.hpp"
#include "host_tools/settings/machine_choice.hpp"
#include "host_tools/settings/quality.hpp"

namespace torolux {

struct Placements {
  Placement radiosity, ray_tracing;  ///< scheme `paper` without copies: the same
  MemoryNeed need;
  std::optional<std::uint32_t> memory;  ///< absent: does not fit
  StageCopies radiosity_copies, ray_tracing_copies;
};

/// The same for the same arguments. Scheme `spread`: heat from some thousand paths; copies as far as --replicate and
/// the memory allow, which is chosen as if there were none. Throws UsageError (grid, allocation).
Placements choose_placements(const Scene& scene, const Camera& camera, const Quality& quality,
                             const MachineChoice& machine, const Mesh& mesh, const StageParameters& parameters,
                             const MemoryMap& map);

}  // namespace torolux
