// SPDX-License-Identifier: MIT
// Some paths are followed, and the rounds gone through in which the host would choose shooters; all that this counts
// becomes cycles by constants that were fitted to measured runs.
#include "host_tools/render/predict.hpp"

#include <algorithm>
#include <numeric>
#include <span>
#include <thread>

#include "firmware/protocol/messages.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/setup/camera_sample.hpp"
#include "host_tools/setup/path_sample.hpp"
#include "host_tools/stages/radiosity_settings.hpp"

namespace torolux {
namespace {

/// Paths that are followed for a prediction, from emitters; each goes on over some surfaces.
constexpr std::uint32_t kPaths = 4000;

/// Cycles of pe.elf with the built-in latencies: fitted to the phases of drafts of cornell_box, interior, glossy_floor
/// and a room with 1,000 boxes on one PE, in both schemes; hand-overs and sent light to what 4 to 16 PEs take more.
/// They give each phase to 12 %, but glossy_floor's records, of which each takes 1,560 cycles to make.
constexpr double kCyclesToMake = 970;     // a hemi-cube pixel's record, with its share of control
constexpr double kCyclesToMakeRay = 800;  // by a PE
constexpr double kCyclesToStart = 730;    // a segment
constexpr double kCyclesPerStep = 44;     // into the next subspace
constexpr double kCyclesPerVisit = 560;   // of one with polygons
constexpr double kCyclesPerBox = 18;
constexpr double kCyclesPerTest = 92;  // of a polygon
constexpr double kCyclesPerDeposit = 420;
constexpr double kCyclesPerTurn = 970;  // of light, at mirror or glass, or by a lobe
constexpr double kCyclesToShow = 1430;  // in place of a deposit: light of a surface, into the frame buffer
constexpr double kCyclesPerRayTurn = 1380;
constexpr double kCyclesPerAim = 765;
constexpr double kCyclesToTakeRay = 340;     // that the host has made
constexpr double kCyclesPerHandOver = 440;   // with a share of its packet; beside the start of what is left
constexpr double kCyclesPerSentLight = 250;  // taken in and added to its element
constexpr double kCyclesPerInstruction = 1.66;
/// Where points stay, of a PE's time in a round; the rest it waits for light that is on its way. With one PE nothing
/// waits.
constexpr double kUtilisation = 0.85;
/// In scheme `spread`: at a round's end a PE waits for others that expand their last point. Of a point's time.
constexpr double kTail = 0.85;
/// In the ray tracing stage, which has no rounds.
constexpr double kRayUtilisation = 0.9;
constexpr double kTileUtilisation = 0.97;

/// Instructions per second of a computer's cores and what a packet costs them, measured on one of 2020.
struct HostSpeed {
  double instructions_per_second;
  double seconds_per_packet;
};
constexpr HostSpeed kQemuSpeed{400e6, 5e-6};
constexpr HostSpeed kTranslatedSpeed{2000e6, 0.5e-6};

/// Records in a packet on its way between PEs, on average: of records handed to neighbours, and of deposits, which wait
/// for each other.
constexpr double kHandedPerPacket = 3.5;
constexpr double kSentPerPacket = 13;

double path_cycles(const PathWork& work, double deposit, double turn) {
  return (work.starts + work.hand_overs) * kCyclesToStart + work.hand_overs * kCyclesPerHandOver +
         work.steps * kCyclesPerStep + work.visits * kCyclesPerVisit + work.boxes * kCyclesPerBox +
         work.tests * kCyclesPerTest + work.deposits * deposit + work.sent_light * kCyclesPerSentLight +
         work.turns * turn + work.aims * kCyclesPerAim;
}

/// Of a round or of a stage: what each PE must do itself, and what is dealt to whoever has least.
struct Load {
  std::vector<double> of_pe;  ///< [cycles]
  double anywhere = 0;

  explicit Load(std::size_t pes) : of_pe(pes) {}
  /// deposit, turn: cycles of one.
  Load(const PathSample& sample, double deposit, double turn) : anywhere(path_cycles(sample.anywhere, deposit, turn)) {
    for (const PathWork& pe : sample.of_pe) of_pe.push_back(path_cycles(pe, deposit, turn));
  }

  void add(const Load& more, double times) {
    for (std::size_t pe = 0; pe < of_pe.size(); ++pe) of_pe[pe] += times * more.of_pe[pe];
    anywhere += times * more.anywhere;
  }
  double sum() const { return std::accumulate(of_pe.begin(), of_pe.end(), anywhere); }
  /// Until the last PE is done.
  double cycles() const {
    return std::max(*std::max_element(of_pe.begin(), of_pe.end()), sum() / static_cast<double>(of_pe.size()));
  }
};

/// Some light may fall on a side of a patch: it does, or what falls on the other side is not known either, as no path
/// of the sample met the patch.
bool may_be_lit(const RenderSetup& setup, const LightSample& light, std::uint32_t patch, std::uint32_t side) {
  const MeshPatch& of = setup.mesh.patches[patch];
  const auto facets = std::span(setup.mesh.facets).subspan(of.first_facet, of.facets);
  const auto falls_on = [&](std::uint32_t one) {
    return std::ranges::any_of(facets, [&](const MeshFacet& facet) {
      return light.emitted.hits[facet.triangle][one] + light.reflected.hits[facet.triangle][one] > 0;
    });
  };
  return falls_on(side) || !falls_on(1 - side);
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
    for (const PathSample* sample : {&light.reflected, &light.emitted}) {
      const PathWork all = sample->sum();
      kinds_.push_back({Load(*sample, kCyclesPerDeposit, kCyclesPerTurn),
                        all.hand_overs / kHandedPerPacket + all.sent_light / kSentPerPacket});
    }
    double emitted = 0;
    for (const Source& source : sources_) emitted += source.unshot;
    greatest_channel_ = kEmittedQuanta / emitted;
    // Rays go the ways of reflected light, backwards; and their answers home.
    for (const FinalGather& of : settings_.gatherings) {
      const double rays = may_be_lit(setup, light, of.number, of.side) ? of.points : 0;
      gather_rays_ += rays * protocol::hemicube_pixels(setup.parameters.hemicube);
    }
  }

  void run(Prediction& prediction) {
    double unshot = kEmittedQuanta / greatest_channel_;
    while (unshot > static_cast<double>(settings_.enough_unshot) && shots_ < most_shots()) {
      const std::size_t chosen = choose();
      if (chosen == 0) break;
      unshot = shoot(chosen, prediction);
    }
    prediction.shots = shots_;
    Load gathering(setup_.placement.torus.pes());
    gathering.anywhere = gather_rays_ * kCyclesToMake;
    gathering.add(kinds_.front().load, gather_rays_);
    add(gathering, gather_rays_, prediction);
    prediction.packets += 2 * gather_rays_ * kinds_.front().packets;
  }

 private:
  struct Kind {
    Load load;       ///< per record
    double packets;  ///< per record
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
    Load round(setup_.placement.torus.pes());
    double emitted = 0;
    double reflected = 0;
    double made = 0;
    for (auto source = sources_.begin(); chosen > 0; ++source) {
      if (!(source->unshot > static_cast<double>(settings_.least_unshot))) continue;
      --chosen;
      const Kind& kind = kind_of(*source);
      const double records = records_of(*source);
      (source->emits ? emitted : reflected) += source->unshot;
      source->unshot = 0;
      (!setup_.points_travel ? round.of_pe[source->pe] : round.anywhere) += records * kCyclesToMake;
      round.add(kind.load, records);
      made += records;
      prediction.packets += records * kind.packets;
      ++shots_;
    }
    double unshot = 0;
    for (Source& source : sources_) {
      source.unshot += emitted * source.from_emitted + reflected * source.from_reflected;
      unshot += source.unshot;
    }
    add(round, made, prediction);
    return unshot;
  }

  void add(const Load& round, double made, Prediction& prediction) const {
    if (!(made > 0)) return;
    prediction.records += made;
    prediction.instructions += round.sum() / kCyclesPerInstruction;
    prediction.radiosity_cycles += round.cycles();
    if (round.of_pe.size() == 1) return;
    if (!setup_.points_travel) {
      prediction.radiosity_cycles += round.cycles() * (1 / kUtilisation - 1);
    } else {
      prediction.radiosity_cycles += kTail * protocol::hemicube_pixels(setup_.parameters.hemicube) * round.sum() / made;
    }
  }

  const RenderSetup& setup_;
  RadiositySettings settings_;
  std::vector<Source> sources_;
  std::vector<Kind> kinds_;  ///< of light reflected, and emitted
  double greatest_channel_;  ///< its share of the flux
  double gather_rays_ = 0;
  std::uint64_t shots_ = 0;
};

/// What the host takes for so many items of work [cycles of the PEs].
double host_cycles(const MachineDescription& machine, HostWork work, double items) {
  const double factor = machine.ideal.host ? 0 : machine.host.cost_factor;
  return factor * machine.host.cycles[static_cast<std::size_t>(work)] * items * machine.processor.clock_hertz /
         machine.host.clock_hertz;
}

/// Of one stage: made by the host, over the bus and into each PE's memory, in turn. What all have alike goes to all at
/// once, where that is sent to all together.
double load_cycles(const RenderSetup& setup, const MachineDescription& machine, protocol::Stage stage) {
  const Placement& placement = setup.placement_of(stage);
  const auto bytes_of = [&](const Placement& of, unsigned pe) {
    const PeLayout made =
        lay_out(setup.mesh, of, static_cast<protocol::PeNumber>(pe), stage, setup.parameters, setup.map);
    const double elements = static_cast<double>(made.layout.elements.count) * sizeof(protocol::Element);
    return static_cast<double>(made.load_end - made.layout.cell_words.address) - elements;
  };
  const unsigned pes = placement.torus.pes();
  const double common = !setup.load_together ? 0 : bytes_of(placement.with_nobody(), pes);
  double all = common;
  double most = 0;
  for (unsigned pe = 0; pe < pes; ++pe) {
    const double bytes = bytes_of(placement, pe);
    all += bytes - common;
    most = std::max(most, bytes);
  }
  const double lines = all / static_cast<double>(kHostLineBytes);
  const double host = host_cycles(machine, HostWork::message, all / protocol::kMostLoadBytes) +
                      host_cycles(machine, HostWork::copy, lines) + host_cycles(machine, HostWork::layout, lines);
  double table = 0;
  if (stage == protocol::Stage::radiosity) {
    table = host_cycles(machine, HostWork::hemicube_entry, protocol::hemicube_weights(setup.parameters.hemicube));
  }
  return table + std::max({all / machine.bus.bytes_per_cycle, most, host});
}

double irradiance_cycles(const RenderSetup& setup, const MachineDescription& machine) {
  double triangles = 0;
  for (const MeshPatch& patch : setup.mesh.patches) {
    for (const std::uint32_t side : patch.side) triangles += side == protocol::kNoSide ? 0 : patch.facets;
  }
  return host_cycles(machine, HostWork::irradiance_triangle, triangles);
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
                        PixelSamples(quality, setup.parameters.seed), setup.parameters.seed);
  const CameraSampleChoice choice = camera_sample_choice(quality, machine, setup.parameters);
  const CameraSample sample = sample_camera(scene, setup.mesh, setup.ray_placement, rays, choice, kPaths);
  // Of pixels that will have more the number is not known.
  const double count = sample.sent * static_cast<double>(quality.width) * quality.height * quality.samples;
  Load load(sample.paths, kCyclesToShow, kCyclesPerRayTurn);
  const bool by_host = setup.parameters.pixel_samples == 0;  // the camera rays
  if (by_host) {
    for (double& pe : load.of_pe) pe += kCyclesToTakeRay / static_cast<double>(load.of_pe.size());
  } else {
    load.anywhere += kCyclesToMakeRay;
  }
  const double utilisation = load.of_pe.size() == 1 ? 1.0 : by_host ? kRayUtilisation : kTileUtilisation;
  prediction.rays = count;
  prediction.ray_tracing_cycles =
      std::max(count * load.cycles() / utilisation, by_host ? count * host_cycles_of_ray(machine.description) : 0.0);
  prediction.instructions += count * load.sum() / kCyclesPerInstruction;
  prediction.packets += count * sample.paths.sum().hand_overs / kHandedPerPacket;
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
  prediction.load_cycles = load_cycles(setup, machine.description, protocol::Stage::radiosity) +
                           load_cycles(setup, machine.description, protocol::Stage::ray_tracing) +
                           irradiance_cycles(setup, machine.description);
  predict_rays(scene, camera, setup, quality, machine, prediction);
  if (draft != nullptr) {
    const Prediction rough = predict_radiosity(scene, *draft, draft_of(quality));
    prediction.draft_cycles =
        kDrafts * (load_cycles(*draft, machine.description, protocol::Stage::radiosity) + rough.radiosity_cycles);
    prediction.draft_records = kDrafts * rough.records;
    prediction.draft_packets = kDrafts * rough.packets;
    prediction.draft_instructions = kDrafts * rough.instructions;
  }
  prediction.wall_seconds =
      wall_seconds_of(prediction.instructions + prediction.draft_instructions,
                      prediction.packets + prediction.draft_packets, machine, setup.placement.torus.pes());
  return prediction;
}

double wall_seconds_of(double instructions, double packets, const MachineChoice& machine, unsigned pes) {
  const unsigned cores = machine.threads != 0 ? machine.threads : std::max(1U, std::thread::hardware_concurrency());
  const HostSpeed& speed = machine.engine == kQemuEngine ? kQemuSpeed : kTranslatedSpeed;
  return instructions / (speed.instructions_per_second * std::min(cores, pes)) + packets * speed.seconds_per_packet;
}

}  // namespace torolux
