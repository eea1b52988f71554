// SPDX-License-Identifier: MIT
// What the radiosity stage leaves: flux of every element and patch side, and the sums that prove none was lost.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "firmware/protocol/stores.hpp"
#include "host_tools/layout/light_units.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {

/// One patch side at the end of the stage; see protocol::PatchSide. [quanta]
struct SolvedSide {
  protocol::Flux incident{};
  protocol::Flux shot{};
  protocol::Flux emission{};
};

/// One side of an element; see protocol::Element. [quanta]
struct SolvedElement {
  protocol::Flux flux{};
  protocol::Flux apart{};
  protocol::Flux gathered{};  ///< by all `points`
  std::uint32_t points = 0;   ///< 0: it has not gathered
  std::uint32_t unused = 0;
};

struct Solution {
  std::vector<SolvedElement> elements;  ///< by global element: Mesh::elements
  std::vector<SolvedSide> sides;        ///< by global patch side: Mesh::patch_sides
  protocol::Tally tally{};              ///< of all PEs
  protocol::Flux emitted_shot{};        ///< flux of all shots of emitted light
  protocol::Flux reflected_shot{};      ///< flux of all shots of reflected light
  protocol::Flux sky_shot{};            ///< flux of the sky's shots; what has entered: sky_entered
  std::uint64_t shots = 0;

  template <class Archive>
  void archive(Archive& archive) {
    archive(elements, sides, tally, emitted_shot, reflected_shot, sky_shot, shots);
  }
};

/// Of the sky's shots, what has entered.
protocol::Flux sky_entered(const Solution& solution);

/// Reflected light that one side of a patch has received and not shot.
protocol::Flux unshot_reflected(const SolvedSide& side, const MeshPatch& patch);

/// [W], R G B.
struct EnergyBalance {
  std::array<double, 3> emitted{}, absorbed{}, absorbed_specular{}, unshot{}, escaped{}, cut_off{}, back_side{};
};

/// Checks in integers that no flux was lost or made: every side's incident flux is that of its elements, and emitted =
/// absorbed + absorbed at specular surfaces + unshot + escaped + cut off + back sides. Throws MachineFailure with the
/// numbers where it does not hold. Returns the balance in watts.
EnergyBalance balance(const Scene& scene, const Mesh& mesh, const LightUnits& units, const Solution& solution);

/// What a record carries in the mean, of the channels [quanta]; 0 where there was none.
double flux_of_record(const Solution& solution);

/// Rays of final gathering have looked for what lights the elements.
bool has_gathered(const Solution& solution);

/// Incident flux by global element; without_direct, of a solution that has not gathered: but for what came straight
/// from emitters.
std::vector<protocol::Flux> incident_flux(const Solution& solution, bool without_direct);

}  // namespace torolux
