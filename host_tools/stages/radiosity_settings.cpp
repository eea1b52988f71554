// SPDX-License-Identifier: MIT
// From reflectances, emission and the quality to the limits of the radiosity stage.
#include "host_tools/stages/radiosity_settings.hpp"
#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/random.hpp"
#include "host_tools/layout/sky_tables.hpp"

#include <algorithm>
#include <cmath>

namespace torolux {

namespace {

/// First word of the keys of the sky's shots; those of patches begin with their numbers.
constexpr std::uint32_t kSkyKey = 0xFFFF'FFFFU;

/// As many points as so many emitting patches have, dealt by the flux that comes in.
std::vector<SkyShot> sky_shots(const Scene& scene, const RenderSetup& setup) {
  std::vector<SkyShot> shots;
  const std::vector<SkyInlet> inlets = sky_inlets(scene, setup.mesh.space);
  const auto flux_of = [](const SkyInlet& inlet) { return inlet.flux[0] + inlet.flux[1] + inlet.flux[2]; };
  double all = 0;
  for (const SkyInlet& inlet : inlets) all += flux_of(inlet);
  const double points = static_cast<double>(inlets.size()) * std::pow(setup.parameters.emission_points, 2);
  for (const SkyInlet& inlet : inlets) {
    SkyShot& shot = shots.emplace_back();
    for (std::size_t c = 0; c < 3; ++c) shot.flux[c] = std::llround(inlet.all[c] / setup.units.watts_per_quantum);
    shot.enters = std::llround(flux_of(inlet) / setup.units.watts_per_quantum);
    constexpr double most = double{protocol::kMostEmissionPoints} * protocol::kMostEmissionPoints;
    shot.points = static_cast<std::uint32_t>(std::clamp(std::round(points * flux_of(inlet) / all), 1.0, most));
    shot.key = protocol::hash_combine(protocol::hash_combine(setup.parameters.seed, kSkyKey),
                                      static_cast<std::uint32_t>(shots.size()));
  }
  return shots;
}

/// A quarter of all rays is shared out by elements, the rest by area.
constexpr double kByElement = 0.25;

std::vector<FinalGather> gatherings(const RenderSetup& setup, std::uint32_t rays) {
  const Mesh& mesh = setup.mesh;
  std::vector<FinalGather> all;
  if (rays == 0) return all;
  double area = 0;
  for (const MeshPatch& patch : mesh.patches) {
    for (const std::uint32_t side : patch.side) area += side != protocol::kNoSide ? patch.area : 0;
  }
  const double points = static_cast<double>(rays) / protocol::hemicube_pixels(setup.parameters.hemicube);
  for (std::uint32_t number = 0; number < mesh.patches.size(); ++number) {
    const MeshPatch& patch = mesh.patches[number];
    const double by_area = (1 - kByElement) * points * mesh.elements * patch.area / area;
    const double by_element = kByElement * points * patch.elements;
    const double most = protocol::kMostGatherPoints;
    const auto& home = setup.placement.patch_home[number];
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (patch.side[side] == protocol::kNoSide) continue;
      const double wanted = std::ceil(std::max<double>(by_area + by_element, patch.elements));
      all.push_back({home.pe, home.local, number, side, static_cast<std::uint32_t>(std::min(wanted, most))});
    }
  }
  return all;
}

/// A ray with its share of a point and its answer takes as long as so many records (docs/decisions/final_gather.md).
constexpr double kRecordsOfRay = 4.0 / 3;
/// Records of all shots for each of emission. Seen in the Cornell box: 4.3.
constexpr double kRecordsOfEmission = 4;

}  // namespace

double foretold_shot_records(const Quality& quality) {
  return kRecordsOfEmission * quality.emission_records;
}

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
  settings.gatherings = gatherings(setup, quality.final_gather);
  settings.shot_records = foretold_shot_records(quality);
  for (const FinalGather& of : settings.gatherings)
    settings.gather_records += kRecordsOfRay * of.points * protocol::hemicube_pixels(setup.parameters.hemicube);
  settings.sky = sky_shots(scene, setup);
  for (const SkyShot& shot : settings.sky) emitted += static_cast<double>(shot.enters);
  settings.emitted = emitted;
  settings.enough_unshot = static_cast<std::int64_t>(emitted * quality.unshot);
  // Where no side has more than this, emitted or reflected, all of them together have no more than `enough_unshot`.
  settings.least_unshot = settings.enough_unshot / (2 * std::max<std::int64_t>(1, mesh.patch_sides));
  return settings;
}

}  // namespace torolux
