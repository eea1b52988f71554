// SPDX-License-Identifier: MIT
// Checks the settings' ranges, makes the mesh, chooses units and the points of shots, then placements and memory. What
// the user should know of it leaves as notes.
#include "host_tools/setup/setup.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "emulator/errors.hpp"
#include "firmware/protocol/cells.hpp"
#include "firmware/protocol/random.hpp"
#include "host_tools/camera/pixel_samples.hpp"
#include "host_tools/layout/lamp_tables.hpp"
#include "host_tools/layout/sky_tables.hpp"
#include "host_tools/scene/surface_shares.hpp"
#include "host_tools/settings/options.hpp"
#include "host_tools/setup/placements.hpp"

namespace torolux {
namespace {

/// Branches that would add less than this to a sample are not followed; weights are divided by the samples.
constexpr float kLeastWeight = 1e-4F;
constexpr std::uint64_t kMostPixels = std::uint64_t{1} << 28U;

void require(bool holds, const std::string& what) {
  if (!holds) throw UsageError(what);
}

void check(const Quality& quality, const MachineChoice& machine) {
  require(quality.width > 0 && quality.height > 0 && std::uint64_t{quality.width} * quality.height <= kMostPixels,
          "--size: at least 1x1 and at most " + std::to_string(kMostPixels) + " pixels");
  const AllSettings settings{quality, {}, {}};
  for (const Option& option : all_options()) {
    if (option.bears_on == BearsOn::machine || option.name.empty()) continue;
    if (const auto allowed = range_fault(option, settings)) throw UsageError(option.name + ": " + *allowed);
  }
  require(
      machine.columns > 0 && machine.rows > 0 && std::uint64_t{machine.columns} * machine.rows <= protocol::kMostPes,
      "--pes: at least 1x1 and at most " + std::to_string(protocol::kMostPes) + " in all");
  if (!quality.adaptive()) return;
  require(quality.samples >= 2 && quality.most_samples >= 2 * std::uint64_t{quality.samples},
          "--most-samples " + std::to_string(quality.most_samples) + " with --samples " +
              std::to_string(quality.samples) +
              ": --samples must be 2 or more, of which two halves are compared, and --most-samples at least twice "
              "that; powers of 2 spread best");
  require(machine.camera_rays == RayMaker::pes,
          "--most-samples asks for camera rays of the PEs: leave out --camera-rays host (or --scheme paper, which "
          "means it)");
}

/// A record of reflected light is to carry no less than this part of what a record of emission does, on average.
constexpr double kFaintestRecord = 0.2;

void choose_points(const Scene& scene, const Mesh& mesh, const Quality& quality, StageParameters& parameters) {
  auto emitting = static_cast<double>(parameters.sky_openings);
  for (const MeshPatch& patch : mesh.patches) {
    for (const std::size_t side : {std::size_t{0}, std::size_t{1}})
      emitting += emits_from(scene, scene.materials[patch.material], side, quality.two_sided_lights) ? 1.0 : 0.0;
  }
  const double wanted = std::sqrt(quality.emission_records / (protocol::hemicube_pixels(quality.hemicube) * emitting));
  parameters.shot_points = quality.shot_points;
  parameters.emission_points =
      static_cast<std::uint32_t>(std::clamp(std::round(wanted), static_cast<double>(quality.shot_points),
                                            static_cast<double>(protocol::kMostEmissionPoints)));
  const double points = emitting * parameters.emission_points * parameters.emission_points;
  parameters.points_per_quantum = static_cast<float>(points / (kFaintestRecord * kEmittedQuanta));
}

/// Gathering rays find what surfaces reflect, straight or through panes. Emitted light they look for only where
/// emitters are large, and there are no shadow rays; else it comes by those, or is kept as shots brought it.
void choose_apart(const Scene& scene, bool gathers, StageParameters& parameters) {
  parameters.apart = protocol::kDirect;
  if (!gathers) return;
  const bool lamps_or_sky = parameters.lamps > 0 || parameters.sky_entries > 0;  // rays meet them by no one radiance
  parameters.gathers_emission = parameters.emitters == 0 && !lamps_or_sky && has_large_emitters(scene) ? 1 : 0;
  parameters.apart = protocol::kTurned;
  if (parameters.emitters == 0 && parameters.gathers_emission == 0) parameters.apart |= protocol::kDirect;
}

double sum_of(const protocol::Flux& flux) {
  return static_cast<double>(flux[0]) + static_cast<double>(flux[1]) + static_cast<double>(flux[2]);
}

/// dense_shot: more records on an element's area than that has rays (docs/decisions/final_gather.md). mean_radiosity:
/// estimated as if no light escaped and all surfaces were lit alike, the ambient term of progressive refinement
/// (M. Cohen et al., "A progressive refinement approach to fast radiosity image generation", SIGGRAPH 1988).
void choose_dense_shots(const Scene& scene, std::uint32_t gather_rays, RenderSetup& setup) {
  const Mesh& mesh = setup.mesh;
  double emitted = 0;
  for (const SkyInlet& inlet : sky_inlets(scene, mesh.space)) {
    for (const double flux : inlet.flux) emitted += flux / setup.units.watts_per_quantum;
  }
  double area = 0;
  double reflecting = 0;
  for (const MeshPatch& patch : mesh.patches) {
    for (std::uint32_t side = 0; side < 2; ++side) {
      if (patch.side[side] == protocol::kNoSide) continue;
      emitted += sum_of(patch_emission(scene, patch, side, setup.units));
      area += patch.area;
      reflecting += patch.area * patch.mean_reflectance();
    }
  }
  const double normalised = area * mesh.space.scale * mesh.space.scale;
  const double absorbing = std::max(area - reflecting, area * 0.01);
  const std::uint32_t rays = std::max(gather_rays, protocol::hemicube_pixels(setup.parameters.hemicube));  // a point's
  setup.parameters.dense_shot = static_cast<float>(static_cast<double>(rays) * mesh.elements / normalised);
  setup.parameters.mean_radiosity = static_cast<float>(std::max(emitted * reflecting / absorbing / normalised, 1.0));
}

/// The map of the cells that each PE has is told before they are filled.
void require_small_map(std::array<std::uint32_t, 3> cells, Scheme scheme, std::uint64_t image, std::uint64_t memory) {
  const auto bytes = [&cells, scheme] {
    std::uint64_t count = 1;
    for (const std::uint32_t n : cells) count *= n;
    const std::uint64_t entries = scheme == Scheme::paper ? count : 0;  // of cells with anything in them, else
    return count / 32 * sizeof(protocol::CellWord) + entries * sizeof(protocol::CellEntry);
  };
  const std::uint64_t needed = bytes();
  if (needed + image <= memory) return;
  while (bytes() > memory / 2) {
    for (std::uint32_t& n : cells) n = std::max(1U, n / 2);
  }
  throw InputError("--subspaces: the map of the subspaces takes " + with_commas(needed) +
                   " bytes beside the image of each PE, which has " + with_commas(memory) + ": use " +
                   std::to_string(cells[0]) + "x" + std::to_string(cells[1]) + "x" + std::to_string(cells[2]) +
                   " or fewer, or more --pe-memory");
}

}  // namespace

Quality draft_of(Quality quality) {
  quality.shot_points = std::max(1U, quality.shot_points / 4);
  quality.emission_records /= 8;
  quality.final_gather = 0;
  quality.unshot = std::max(quality.unshot, 0.05);
  return quality;
}

std::uint32_t machine_seed(std::uint64_t seed) {
  const std::uint32_t low = protocol::hash_combine(0, static_cast<std::uint32_t>(seed));
  return protocol::hash_combine(low, static_cast<std::uint32_t>(seed >> 32U));
}

MeshChoice mesh_choice(const Quality& quality, const std::vector<Split>& splits) {
  return {quality.patch_length, quality.element_length, quality.two_sided_lights, quality.texels, splits,
          quality.patch_factor, quality.element_factor, quality.cluster_factor};
}

RenderSetup make_setup(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                       const Image& image, const std::vector<Split>& splits) {
  check(quality, machine);
  // Rays of the host that miss the object space never reach a PE, and the sky that they see no frame buffer.
  require(!scene.sky || machine.camera_rays == RayMaker::pes, "--camera-rays: pes only, in a scene with a [sky]");
  RenderSetup setup;
  const std::uint64_t memory = machine.pe_memory.value_or(protocol::kLargestLocalMemory);
  const std::uint64_t pes = std::uint64_t{machine.columns} * machine.rows;
  if (machine.subspaces)
    require_small_map(*machine.subspaces, machine.scheme, image.stores_begin - protocol::kLocalMemoryBase, memory);
  setup.mesh = make_mesh(scene, mesh_choice(quality, splits), pes * memory);
  setup.notes = setup.mesh.notes;
  setup.units = light_units(scene, setup.mesh, quality.two_sided_lights);
  setup.parameters.seed = machine_seed(quality.seed);
  setup.parameters.bounces = quality.bounces;
  setup.parameters.hemicube = quality.hemicube;
  const SkyTables sky = sky_tables(scene, setup.units);
  setup.parameters.sky_frame = sky.frame;
  setup.parameters.sky_entries = static_cast<std::uint32_t>(sky.entries.size());
  setup.parameters.sky_openings = static_cast<std::uint32_t>(sky_inlets(scene, setup.mesh.space).size());
  const LampTables lamps = lamp_tables(scene);
  setup.parameters.lamps = static_cast<std::uint32_t>(lamps.lamps.size());
  setup.parameters.lamp_values = static_cast<std::uint32_t>(lamps.values.size());
  setup.parameters.lamp_chances = static_cast<std::uint32_t>(lamps.chances.size());
  choose_points(scene, setup.mesh, quality, setup.parameters);
  setup.parameters.pixel_scale = pixel_scale(setup.mesh, setup.units);
  setup.parameters.layers = quality.layers;
  if (quality.shadow_rays) {
    setup.parameters.emitters = static_cast<std::uint32_t>(emitters(scene, setup.mesh, setup.units).size());
  }
  choose_apart(scene, quality.final_gather > 0, setup.parameters);
  if (quality.final_gather > 0) choose_dense_shots(scene, quality.final_gather, setup);
  setup.parameters.least_weight = kLeastWeight / static_cast<float>(quality.sample_places());
  const MachineDescription::Records& records = machine.description.records;
  setup.map = {image.stores_begin, records.niu_slots, records.credits_per_pe, records.gather_cycles,
               records.gather_records};
  setup.load_together = machine.scheme == Scheme::spread;
  setup.points_travel = machine.points == Points::travel;
  if (machine.camera_rays == RayMaker::pes) {
    setup.parameters.pixel_samples = quality.sample_places();
    setup.parameters.filter_entries = PixelSamples::entries(quality.filter, quality.sample_places());
  }
  Placements placements = choose_placements(scene, camera, quality, machine, setup.mesh, setup.parameters, setup.map);
  setup.placement = std::move(placements.radiosity);
  setup.ray_placement = std::move(placements.ray_tracing);
  setup.radiosity_copies = placements.radiosity_copies;
  setup.ray_tracing_copies = placements.ray_tracing_copies;
  setup.need = std::move(placements.need);
  setup.memory = placements.memory;
  setup.credits = std::uint64_t{machine.description.records.credits_per_pe} * setup.placement.torus.pes();
  if (!machine.pe_memory && setup.memory) {
    setup.notes.push_back("memory of each PE: " + with_commas(*setup.memory) + " bytes (the fullest, PE " +
                          std::to_string(setup.need.fullest) + ", needs " + with_commas(setup.need.most()) + ")");
  }
  if (const std::uint32_t idle = setup.placement.idle_pes(); idle > 0) {
    setup.notes.push_back(with_commas(idle) + " of " + with_commas(setup.placement.torus.pes()) +
                          " PEs hold nothing of the scene, and have little to do or nothing: use fewer --pes, finer "
                          "--subspaces, or --allocation balanced");
  }
  for (const SceneMaterial& material : scene.materials) {
    if (material.kind != SurfaceKind::diffuse && material.emission != Vec3d{0, 0, 0}) {
      setup.notes.push_back("material '" + material.name + "' is mirror or glass: its emission (Ke) is ignored");
    }
  }
  return setup;
}

}  // namespace torolux
