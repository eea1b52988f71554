// SPDX-License-Identifier: MIT
// A geometric series for each channel, over the whole scene: what is unshot, times what becomes of each quantum.
#include "host_tools/solution/foreseen_flux.hpp"

namespace torolux {
namespace {

using protocol::Flux;

/// Reflected light that has come and not left again.
Flux unshot_flux(const Mesh& mesh, const Solution& solution) {
  Flux unshot{};
  for (const MeshPatch& patch : mesh.patches) {
    for (const std::uint32_t number : patch.side) {
      if (number == protocol::kNoSide) continue;
      const Flux rest = unshot_reflected(solution.sides[number], patch);
      for (std::size_t c = 0; c < 3; ++c) unshot[c] += rest[c];
    }
  }
  return unshot;
}

/// So much more reflected light is to come, beside what has been shot.
std::array<double, 3> parts_to_come(const Mesh& mesh, const Solution& solution) {
  const Flux unshot = unshot_flux(mesh, solution);
  const Flux entered = sky_entered(solution);
  std::array<double, 3> parts{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto first = static_cast<double>(solution.emitted_shot[c] + entered[c]);
    const auto reflected = static_cast<double>(solution.reflected_shot[c]);
    const auto rest = static_cast<double>(unshot[c]);
    // Of all that was shot, (reflected + rest) came back to be shot again; 1 / (1 - that part) sums up all further
    // ones.
    if (reflected > 0 && rest < first) parts[c] = rest * (first + reflected) / (first - rest) / reflected;
  }
  return parts;
}

}  // namespace

std::vector<Flux> foreseen_flux(const Mesh& mesh, const Solution& solution, bool without_direct) {
  const std::array<double, 3> parts = parts_to_come(mesh, solution);
  std::vector<Flux> flux = incident_flux(solution, without_direct);
  for (std::size_t e = 0; e < flux.size(); ++e) {
    const SolvedElement& element = solution.elements[e];
    for (std::size_t c = 0; c < 3; ++c)
      flux[e][c] += static_cast<std::int64_t>(static_cast<double>(element.flux[c] - element.direct[c]) * parts[c]);
  }
  return flux;
}

}  // namespace torolux
