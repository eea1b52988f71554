// SPDX-License-Identifier: MIT
// A geometric series for each channel, over the whole scene: what is unshot, times what becomes of each quantum.
#include "host_tools/solution/foreseen_flux.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace torolux {
namespace {

using protocol::Flux;

/// The variance of what rays find beside that of as many records of equal flux by chance: they look evenly around, and
/// each finds something.
constexpr double kVarianceOfRays = 0.3;

double sum_of(const Flux& flux) {
  return static_cast<double>(flux[0]) + static_cast<double>(flux[1]) + static_cast<double>(flux[2]);
}

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
std::array<double, 3> parts_to_come(const Flux& unshot, const Solution& solution) {
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

/// Where light from emitters and reflected light cannot be told apart: what is to come of both together beside what
/// came of both. emission_found: beside what rays found, which is what was emitted, and all that reflects what came.
std::array<double, 3> foreseen_part(const Mesh& mesh, const Solution& solution, bool emission_found) {
  const Flux unshot = unshot_flux(mesh, solution);
  const std::array<double, 3> parts = parts_to_come(unshot, solution);
  const Flux entered = sky_entered(solution);
  std::array<double, 3> foreseen{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto reflected = static_cast<double>(solution.reflected_shot[c]);
    const double all = reflected + static_cast<double>(solution.emitted_shot[c] + entered[c]);
    const double came = emission_found ? all + static_cast<double>(unshot[c]) : all;
    foreseen[c] = came > 0 ? (all + parts[c] * reflected) / came : 1;
  }
  return foreseen;
}

/// No more than a flux can be.
std::int64_t quanta(double value) {
  return std::llround(std::min(value, 0x1p60));
}

std::vector<Flux> times(std::vector<Flux> flux, const std::array<double, 3>& factor) {
  for (Flux& of : flux) {
    for (std::size_t c = 0; c < 3; ++c) of[c] = quanta(static_cast<double>(of[c]) * factor[c]);
  }
  return flux;
}

}  // namespace

std::vector<Flux> foreseen_flux(const Mesh& mesh, const Solution& solution, bool without_direct) {
  if (has_gathered(solution)) return times(incident_flux(solution, false), foreseen_part(mesh, solution, false));
  const std::array<double, 3> parts = parts_to_come(unshot_flux(mesh, solution), solution);
  std::vector<Flux> flux = incident_flux(solution, without_direct);
  for (std::size_t e = 0; e < flux.size(); ++e) {
    const SolvedElement& element = solution.elements[e];
    for (std::size_t c = 0; c < 3; ++c)
      flux[e][c] += static_cast<std::int64_t>(static_cast<double>(element.flux[c] - element.apart[c]) * parts[c]);
  }
  return flux;
}

PictureLight picture_light(const Mesh& mesh, const Solution& solution, bool without_direct, bool emission_found) {
  const double of_record = flux_of_record(solution);
  if (!has_gathered(solution)) {
    PictureLight light{foreseen_flux(mesh, solution, without_direct), {}};
    if (of_record > 0) light.of_record.assign(light.flux.size(), of_record);
    return light;
  }
  // Of what lights the surfaces that rays have met.
  const std::array<double, 3> foreseen = foreseen_part(mesh, solution, emission_found);
  PictureLight light;
  light.flux.reserve(solution.elements.size());
  light.of_record.reserve(solution.elements.size());
  double all_found = 0;
  for (const SolvedElement& element : solution.elements)
    all_found += element.points > 0 ? sum_of(element.gathered) / element.points : 0;
  const double of_ray = kVarianceOfRays * all_found / 3 / static_cast<double>(solution.tally.gather_rays);
  for (const SolvedElement& element : solution.elements) {
    Flux& sum = light.flux.emplace_back(element.apart);
    for (std::size_t c = 0; c < 3 && element.points > 0; ++c)
      sum[c] += quanta(static_cast<double>(element.gathered[c]) / element.points * foreseen[c]);
    const double apart = sum_of(element.apart);
    const double all = sum_of(sum);
    light.of_record.push_back(all > 0 ? (apart * of_record + (all - apart) * of_ray) / all : of_ray);
  }
  return light;
}

}  // namespace torolux
