// SPDX-License-Identifier: MIT
// The energy balance of a solution, exact in integers. See solution.hpp.
#include <string>

#include "emulator/errors.hpp"
#include "firmware/protocol/flux.hpp"
#include "host_tools/solution/solution.hpp"

namespace torolux {
namespace {

using protocol::Flux;

void add_to(Flux& sum, const Flux& more) {
  for (std::size_t c = 0; c < 3; ++c) sum[c] += more[c];
}

void require_equal(const Flux& a, const Flux& b, const std::string& what) {
  for (std::size_t c = 0; c < 3; ++c) {
    if (a[c] == b[c]) continue;
    throw MachineFailure("light was lost or made: " + what + ", channel " + std::to_string(c) + ": " +
                         std::to_string(a[c]) + " and " + std::to_string(b[c]) + " quanta");
  }
}

struct Sums {
  Flux emitted{}, incident{}, unshot_emission{}, unshot_reflected{};
};

void add_patch(const Scene& scene, const MeshPatch& patch, std::size_t number, const LightUnits& units,
               const Solution& solution, Sums& sums) {
  for (std::uint32_t s = 0; s < 2; ++s) {
    if (patch.side[s] == protocol::kNoSide) continue;
    const SolvedSide& side = solution.sides[patch.side[s]];
    Flux elements{};
    for (std::uint32_t e = 0; e < patch.elements; ++e) {
      add_to(elements, solution.elements[patch.first_element[s] + e].flux);
    }
    require_equal(elements, side.incident, "elements and patch " + std::to_string(number));
    add_to(sums.emitted, patch_emission(scene, patch, s, units));
    add_to(sums.incident, side.incident);
    add_to(sums.unshot_emission, side.emission);
    add_to(sums.unshot_reflected, unshot_reflected(side, patch));
  }
}

}  // namespace

Flux sky_entered(const Solution& solution) {
  Flux entered = solution.sky_shot;
  for (std::size_t c = 0; c < 3; ++c) entered[c] -= solution.tally.sky_rest[c];
  return entered;
}

Flux unshot_reflected(const SolvedSide& side, const MeshPatch& patch) {
  Flux unshot{};
  for (std::size_t c = 0; c < 3; ++c)
    unshot[c] = protocol::scale_down(side.incident[c] - side.shot[c], patch.reflectance[c]);
  return unshot;
}

EnergyBalance balance(const Scene& scene, const Mesh& mesh, const LightUnits& units, const Solution& solution) {
  Sums sums;
  for (std::size_t p = 0; p < mesh.patches.size(); ++p) add_patch(scene, mesh.patches[p], p, units, solution, sums);
  const protocol::Tally& tally = solution.tally;
  Flux shot = solution.emitted_shot;
  add_to(shot, solution.reflected_shot);
  const Flux entered = sky_entered(solution);
  add_to(shot, entered);
  Flux arrived = sums.incident;
  for (const Flux* part : {&tally.absorbed_specular, &tally.escaped, &tally.cut_off, &tally.back_side}) {
    add_to(arrived, *part);
  }
  add_to(shot, tally.reflected_glossy);
  require_equal(shot, arrived, "flux shot or reflected by glossy lobes, and flux that arrived");
  Flux left = solution.emitted_shot;
  add_to(left, sums.unshot_emission);
  require_equal(sums.emitted, left, "flux emitted and flux of emitters' shots and rests");

  EnergyBalance energy;
  const auto watts = [&units](std::int64_t quanta) { return static_cast<double>(quanta) * units.watts_per_quantum; };
  for (std::size_t c = 0; c < 3; ++c) {
    energy.emitted[c] = watts(sums.emitted[c] + entered[c]);
    energy.absorbed[c] =
        watts(sums.incident[c] - solution.reflected_shot[c] - sums.unshot_reflected[c] - tally.reflected_glossy[c]);
    energy.absorbed_specular[c] = watts(tally.absorbed_specular[c]);
    energy.unshot[c] = watts(sums.unshot_emission[c] + sums.unshot_reflected[c]);
    energy.escaped[c] = watts(tally.escaped[c]);
    energy.cut_off[c] = watts(tally.cut_off[c]);
    energy.back_side[c] = watts(tally.back_side[c]);
  }
  return energy;
}

bool has_gathered(const Solution& solution) {
  return solution.tally.gather_rays > 0;
}

double flux_of_record(const Solution& solution) {
  if (solution.tally.rays == 0) return 0;
  const Flux entered = sky_entered(solution);
  double sum = 0;
  for (std::size_t c = 0; c < 3; ++c)
    sum += static_cast<double>(solution.emitted_shot[c] + solution.reflected_shot[c] + entered[c]);
  return sum / 3 / static_cast<double>(solution.tally.rays);
}

std::vector<Flux> incident_flux(const Solution& solution, bool without_direct) {
  std::vector<Flux> flux;
  flux.reserve(solution.elements.size());
  for (const SolvedElement& element : solution.elements) {
    Flux& sum = flux.emplace_back(element.flux);
    for (std::size_t c = 0; without_direct && c < 3; ++c) sum[c] -= element.apart[c];
  }
  return flux;
}

}  // namespace torolux
