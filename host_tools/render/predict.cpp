// SPDX-License-Identifier: MIT
// See predict.hpp.
#include "host_tools/render/predict.hpp"

#include <algorithm>
#include <thread>

#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/render/camera_sample.hpp"
#include "host_tools/render/path_sample.hpp"

namespace torolux {
namespace {

/// Paths that are followed for a prediction, from emitters; each goes on over some surfaces.
constexpr std::uint32_t kPaths = 4000;

/// Cycles of pe.elf with the built-in latencies: fitted to the phases of renders of cornell_box, cornell_spheres,
/// glossy_floor and two_mirrors on 1x1 to 4x4 PEs. They give the instructions for each record to 3 %, of
/// cornell_spheres, where few of many polygons are met, to 17 %.
constexpr double kCyclesToMake = 1450;    // a hemi-cube pixel's record, with its share of control
constexpr double kCyclesToStart = 1750;   // a segment: set-up, and the polygons that it really meets
constexpr double kCyclesPerVisit = 130;   // of a subspace
constexpr double kCyclesPerPolygon = 46;  // in its list; most are passed over by their boxes
constexpr double kCyclesPerArrival = 800;
constexpr double kCyclesPerTurn = 1000;  // at mirror or glass, or by a lobe
constexpr double kCyclesPerDeposit = 400;
constexpr double kCyclesToShow = 1000;  // in place of a deposit: light of a surface, into the frame buffer
constexpr double kCyclesPerInstruction = 1.7;
/// Of a PE's time in a round; the rest it waits for light that is on its way. With one PE nothing waits.
constexpr double kUtilisation = 0.85;
/// In the ray tracing stage, which has no rounds.
constexpr double kRayUtilisation = 0.9;

/// Instructions per second of this computer's cores and what a packet costs them, measured on one of 2020.
struct HostSpeed {
  double instructions_per_second;
  double seconds_per_packet;
};
constexpr HostSpeed kQemuSpeed{400e6, 5e-6};
constexpr HostSpeed kTranslatedSpeed{2000e6, 0.5e-6};

/// Records in a packet on its way between PEs, on average.
constexpr double kRecordsPerPacket = 9;

double path_cycles(const PathWork& work, double deposit) {
  return work.starts * kCyclesToStart + work.arrivals * kCyclesPerArrival + work.visits * kCyclesPerVisit +
         work.polygons * kCyclesPerPolygon + work.turns * kCyclesPerTurn + work.deposits * deposit;
}

/// Cycles of each PE per record of a sample. deposit: cycles of one.
std::vector<double> cycles_of_pes(const PathSample& sample, double deposit = kCyclesPerDeposit) {
  std::vector<double> cycles;
  for (const PathWork& pe : sample.of_pe) cycles.push_back(path_cycles(pe, deposit));
  return cycles;
}

/// One side of a patch as a source of light. Of all emitted light the same share falls on it as of the sample's, and
/// likewise of all reflected light, wherever that comes from.
struct Source {
  double unshot;          ///< [quanta, R + G + B]
  double from_emitted;    ///< share of what is shot of emitted light that this side will reflect
  double from_reflected;  ///< and of reflected light
  std::uint32_t pe;
  bool emits;
};

std::vector<Source> sources_of(const Scene& scene, const RenderSetup& setup, const LightSample& light) {
  std::vector<Source> sources;
  for (std::size_t p = 0; p < setup.mesh.patches.size(); ++p) {
    const MeshPatch& patch = setup.mesh.patches[p];
    const double reflectance = patch.mean_reflectance();
    const std::uint32_t pe = setup.placement.patch_home[p].pe;
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (patch.side[side] == protocol::kNoSide) continue;
      const protocol::Flux emission = patch_emission(scene, patch, side, setup.units);
      const auto emitted = static_cast<double>(emission[0] + emission[1] + emission[2]);
      double of_emitted = 0;
      double of_reflected = 0;
      for (std::uint32_t f = patch.first_facet; f < patch.first_facet + patch.facets; ++f) {
        const MeshFacet& facet = setup.mesh.facets[f];
        const double share = reflectance * setup.mesh.facet_area(facet) / setup.mesh.triangles[facet.triangle].area;
        of_emitted += share * light.emitted.hits[facet.triangle][side];
        of_reflected += share * light.reflected.hits[facet.triangle][side];
      }
      sources.push_back({0, of_emitted, of_reflected, pe, false});
      if (emitted > 0) sources.push_back({emitted, 0, 0, pe, true});
    }
  }
  return sources;
}

/// The radiosity stage round by round: who would shoot, and how long the busiest PE would be at it.
class Rounds {
 public:
  Rounds(const Scene& scene, const RenderSetup& setup, const Quality& quality, const LightSample& light)
      : setup_(setup), settings_(radiosity_settings(scene, setup, quality)), sources_(sources_of(scene, setup, light)) {
    kinds_ = {Kind{cycles_of_pes(light.reflected), light.reflected.sum().arrivals},
              Kind{cycles_of_pes(light.emitted), light.emitted.sum().arrivals}};
    double emitted = 0;
    for (const Source& source : sources_) emitted += source.unshot;
    greatest_channel_ = kEmittedQuanta / emitted;
  }

  void run(Prediction& prediction) {
    double unshot = kEmittedQuanta / greatest_channel_;
    while (unshot > static_cast<double>(settings_.enough_unshot) && shots_ < most_shots()) {
      const std::size_t chosen = choose();
      if (chosen == 0) break;
      unshot = shoot(chosen, prediction);
    }
    prediction.shots = shots_;
  }

 private:
  /// Of light reflected, or emitted.
  struct Kind {
    std::vector<double> cycles;  ///< of each PE, per record
    double arrivals;             ///< per record
  };
  const Kind& kind_of(const Source& source) const { return kinds_[source.emits ? 1 : 0]; }
  /// Of a shot, as if light had everywhere the colour that it was emitted in.
  double records_of(const Source& source) const {
    const StageParameters& parameters = setup_.parameters;
    const double points = source.unshot * greatest_channel_ * parameters.points_per_quantum;
    const double grid =
        source.emits ? parameters.emission_points
                     : std::clamp(std::ceil(std::sqrt(points)), 1.0, static_cast<double>(parameters.shot_points));
    return protocol::hemicube_pixels(parameters.hemicube) * grid * grid;
  }
  std::uint64_t most_shots() const { return settings_.max_shots > 0 ? settings_.max_shots : 10'000'000; }

  /// Puts the shooters of the next round in front; their number.
  std::size_t choose() {
    const auto most = std::min<std::uint64_t>({settings_.shooters, sources_.size(), most_shots() - shots_});
    const auto end = sources_.begin() + static_cast<std::ptrdiff_t>(most);
    const auto more = [](const Source& a, const Source& b) { return a.unshot > b.unshot; };
    if (end != sources_.end()) std::nth_element(sources_.begin(), end, sources_.end(), more);
    return static_cast<std::size_t>(std::count_if(sources_.begin(), end, [this](const Source& source) {
      return source.unshot > static_cast<double>(settings_.least_unshot);
    }));
  }

  /// What is unshot afterwards.
  double shoot(std::size_t chosen, Prediction& prediction) {
    std::vector<double> busy(setup_.placement.torus.pes());
    double emitted = 0;
    double reflected = 0;
    for (auto source = sources_.begin(); chosen > 0; ++source) {
      if (!(source->unshot > static_cast<double>(settings_.least_unshot))) continue;
      --chosen;
      const Kind& kind = kind_of(*source);
      const double records = records_of(*source);
      (source->emits ? emitted : reflected) += source->unshot;
      source->unshot = 0;
      busy[source->pe] += records * kCyclesToMake;
      for (std::size_t pe = 0; pe < busy.size(); ++pe) busy[pe] += records * kind.cycles[pe];
      prediction.records += records;
      prediction.packets += records * kind.arrivals / kRecordsPerPacket;
      ++shots_;
    }
    double unshot = 0;
    for (Source& source : sources_) {
      source.unshot += emitted * source.from_emitted + reflected * source.from_reflected;
      unshot += source.unshot;
    }
    for (const double cycles : busy) prediction.instructions += cycles / kCyclesPerInstruction;
    prediction.radiosity_cycles += *std::max_element(busy.begin(), busy.end()) / (busy.size() > 1 ? kUtilisation : 1.0);
    return unshot;
  }

  const RenderSetup& setup_;
  RadiositySettings settings_;
  std::vector<Source> sources_;
  std::array<Kind, 2> kinds_;
  double greatest_channel_;  ///< its share of the flux
  std::uint64_t shots_ = 0;
};

/// What the host takes for so many items of work [cycles of the PEs].
double host_cycles(const MachineDescription& machine, HostWork work, double items) {
  const double factor = machine.ideal.host ? 0 : machine.host.cost_factor;
  return factor * machine.host.cycles[static_cast<std::size_t>(work)] * items * machine.processor.clock_hertz /
         machine.host.clock_hertz;
}

/// Of one stage, made by the host, over the bus in turn and into each PE's memory.
double load_cycles(const RenderSetup& setup, const MachineDescription& machine) {
  double all = 0;
  for (const std::uint64_t bytes : setup.need.pe_bytes) all += static_cast<double>(bytes);
  const double lines = all / static_cast<double>(kHostLineBytes);
  const double host = host_cycles(machine, HostWork::message, all / protocol::kMostLoadBytes) +
                      host_cycles(machine, HostWork::copy, lines) + host_cycles(machine, HostWork::layout, lines);
  return std::max({all / machine.bus.bytes_per_cycle, static_cast<double>(setup.need.most()), host});
}

double lattice_cycles(const RenderSetup& setup, const MachineDescription& machine) {
  double triangles = 0;
  for (const MeshPatch& patch : setup.mesh.patches) {
    for (const std::uint32_t side : patch.side) triangles += side == protocol::kNoSide ? 0 : patch.facets;
  }
  return host_cycles(machine, HostWork::lattice_triangle, triangles);
}

/// Subspaces that a camera ray enters before it begins.
constexpr double kSubspacesOfRay = 4;
double host_cycles_of_ray(const MachineDescription& machine) {
  const double packet = 1.0 / protocol::records_per_packet(protocol::Stage::ray_tracing);
  return host_cycles(machine, HostWork::camera_ray, 1) + host_cycles(machine, HostWork::subspace, kSubspacesOfRay) +
         host_cycles(machine, HostWork::message, packet) +
         host_cycles(machine, HostWork::copy, static_cast<double>(host_lines(sizeof(protocol::RayRecord))));
}

void predict_rays(const Scene& scene, const Camera& camera, const RenderSetup& setup, const Quality& quality,
                  const MachineChoice& machine, Prediction& prediction) {
  const CameraRays rays(camera, setup.mesh.space, quality.width, quality.height,
                        PixelSamples(quality.filter, quality.samples, setup.parameters.seed), setup.parameters.seed);
  const CameraSampleChoice choice = camera_sample_choice(quality, machine, setup.parameters);
  const CameraSample sample = sample_camera(scene, setup.mesh, setup.ray_placement, rays, choice, kPaths);
  const double count = sample.sent * static_cast<double>(rays.count());
  const std::vector<double> cycles = cycles_of_pes(sample.paths, kCyclesToShow);
  const bool host_makes_rays = setup.parameters.pixel_samples == 0;
  const double busiest = *std::max_element(cycles.begin(), cycles.end());
  double sum = 0;
  for (const double pe : cycles) sum += pe;
  prediction.rays = count;
  prediction.ray_tracing_cycles = std::max(count * busiest / (cycles.size() > 1 ? kRayUtilisation : 1.0),
                                           host_makes_rays ? count * host_cycles_of_ray(machine.description) : 0.0);
  prediction.instructions += count * sum / kCyclesPerInstruction;
  prediction.packets += count * sample.paths.sum().arrivals / kRecordsPerPacket;
}

/// Of the radiosity stage: what `predict` then takes for the draft's, too.
Prediction predict_radiosity(const Scene& scene, const RenderSetup& setup, const Quality& quality) {
  Prediction prediction;
  const LightSample light = sample_light(scene, setup.mesh, setup.placement, quality.bounces, kPaths);
  Rounds(scene, setup, quality, light).run(prediction);
  return prediction;
}

}  // namespace

Prediction predict(const Scene& scene, const Camera& camera, const RenderSetup& setup, const RenderSetup* draft,
                   const Quality& quality, const MachineChoice& machine) {
  Prediction prediction = predict_radiosity(scene, setup, quality);
  prediction.load_cycles = 2 * load_cycles(setup, machine.description) + lattice_cycles(setup, machine.description);
  predict_rays(scene, camera, setup, quality, machine, prediction);
  if (draft != nullptr) {
    const Prediction rough = predict_radiosity(scene, *draft, draft_of(quality));
    prediction.draft_cycles = kDrafts * (load_cycles(*draft, machine.description) + rough.radiosity_cycles);
    prediction.draft_records = kDrafts * rough.records;
    prediction.draft_packets = kDrafts * rough.packets;
    prediction.draft_instructions = kDrafts * rough.instructions;
  }
  const unsigned cores = machine.threads != 0 ? machine.threads : std::max(1U, std::thread::hardware_concurrency());
  const HostSpeed& speed = machine.engine == kQemuEngine ? kQemuSpeed : kTranslatedSpeed;
  prediction.wall_seconds = (prediction.instructions + prediction.draft_instructions) /
                                (speed.instructions_per_second * std::min(cores, setup.placement.torus.pes())) +
                            (prediction.packets + prediction.draft_packets) * speed.seconds_per_packet;
  return prediction;
}

}  // namespace torolux
