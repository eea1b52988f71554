// SPDX-License-Identifier: MIT
// One render: scene and settings in; picture, figures and, on request, the saved radiosities out.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/machine/machine.hpp"
#include "host_tools/layout/scheme.hpp"
#include "host_tools/picture/layers.hpp"
#include "host_tools/picture/picture.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/stages/pixel_samples.hpp"
#include "host_tools/stages/rounds.hpp"

namespace torolux {

/// 16 MiB of a PE's memory.
inline constexpr std::uint32_t kMostTexels = 4U << 20U;

/// Everything that determines the picture, and nothing that does not.
struct Quality {
  std::uint32_t width = 512, height = 512;
  std::uint32_t samples = 16;  ///< per pixel
  PixelFilter filter = PixelFilter::box;
  LayerSet layers = 0;                 ///< of the picture, besides its colours, which they do not change
  std::optional<double> patch_length;  ///< longest edge, scene units; absent: auto
  std::optional<double> element_length;
  double patch_factor = 1, element_factor = 1;  ///< of lengths that are chosen by themselves
  /// Of elements of several small triangles each, which are not refined, times the length of the others.
  double cluster_factor = 1;
  /// Elements that are added where a draft of the solution says so, as a multiple of those without; 0: no draft.
  double refine = 0;
  std::uint32_t hemicube = 8;     ///< pixels across the top, even, 4..256
  std::uint32_t shot_points = 6;  ///< k: k * k points per patch
  /// With which all emitters together begin, about: their light casts the sharpest shadows, so that a patch that emits
  /// gets more points than one that only reflects.
  std::uint32_t emission_records = 4'000'000;
  double unshot = 0.002;        ///< fraction of the emitted flux at which the radiosity stage ends
  std::uint32_t max_shots = 0;  ///< patches shot in all; 0: no limit
  std::uint32_t bounces = 32;   ///< path segments
  /// Light straight from emitters comes by a shadow ray from each diffuse point that is seen, not from the elements.
  bool shadow_rays = true;
  bool two_sided_lights = false;
  std::uint32_t texels = 16384;  ///< of each texture, at most; 1..kMostTexels
  std::uint64_t seed = 1;
};

/// The machine that makes it.
struct MachineChoice {
  MachineDescription description;
  unsigned columns = 4, rows = 4;
  std::optional<std::uint32_t> pe_memory;                 ///< bytes; absent: smallest power of two from 1 MiB that fits
  std::optional<std::array<std::uint32_t, 3>> subspaces;  ///< absent: auto
  Scheme scheme = Scheme::spread;  ///< the values below are its own; another scheme's: take_scheme
  std::string allocation = allocation_of(Scheme::spread);
  std::optional<double> replicate;  ///< most of a PE's memory for copies of subspaces, 0..1; absent: what fits
  Points points = points_of(Scheme::spread);
  Empty empty = empty_of(Scheme::spread);
  RayMaker camera_rays = camera_rays_of(Scheme::spread);
  bool skip_empty_subspaces = true;  ///< the host's camera rays begin in the first subspace on their way that is full
  std::string engine = kDefaultEngine;
  Debugging debugging;
  unsigned threads = 0;
  MachineWatcher* watcher = nullptr;  ///< of the machine that makes the picture, not of drafts'; outlives the render
};

/// The scheme, and all that it has where nothing else is said.
inline void take_scheme(MachineChoice& machine, Scheme scheme) {
  machine.scheme = scheme;
  machine.allocation = allocation_of(scheme);
  machine.replicate = replicate_of(scheme);
  machine.points = points_of(scheme);
  machine.empty = empty_of(scheme);
  machine.camera_rays = camera_rays_of(scheme);
}

enum class RenderStage { load, radiosity, ray_tracing };

struct RenderProgress {
  RenderStage stage;
  double fraction;         ///< of the stage, estimated, 0..1
  double unshot_fraction;  ///< of the emitted flux
  std::uint64_t credits_home, credits_total;
  Cycles virtual_time;
  double overall = 0;  ///< of all stages together, drafts' included, 0..1; rough
};

/// Subspaces that stand on every PE in a stage.
struct StageCopies {
  std::uint64_t cells = 0;
  std::uint64_t bytes = 0;  ///< that they take of each PE's memory, surfaces that all have included
  std::uint64_t kept = 0;   ///< surfaces that one PE alone has (ray tracing stage)
};

/// [W], R G B.
struct EnergyBalance {
  std::array<double, 3> emitted{}, absorbed{}, absorbed_specular{}, unshot{}, escaped{}, cut_off{}, back_side{};
};

struct RenderFigures {
  Cycles load_cycles = 0, radiosity_cycles = 0, ray_tracing_cycles = 0;  ///< of each stage
  MachineFigures machine;
  std::vector<RoundFigures> rounds;  ///< of the radiosity stage
  VisitSums radiosity_visits{}, ray_visits{};
  EnergyBalance energy;
  std::uint64_t shots = 0;  ///< patches shot
  std::uint64_t radiosity_records = 0;
  std::uint64_t rays = 0;   ///< camera rays
  Cycles draft_cycles = 0;  ///< of the machines that solved the drafts
  std::uint64_t draft_records = 0;
  std::uint64_t splits = 0;                           ///< elements that were cut by it
  std::uint64_t credits_total = 0, credits_home = 0;  ///< at the end
  double wall_seconds = 0;
  double run_seconds = 0;  ///< of those, while the picture's machine ran: without mesh, translation and drafts
  std::uint32_t local_memory_bytes = 0;  ///< per PE, as chosen
  std::array<std::uint32_t, 3> subspaces{};
  std::uint64_t filled_subspaces = 0;                ///< with anything in them
  StageCopies radiosity_copies, ray_tracing_copies;  ///< of those
  std::string picture_sha256;              ///< of the colours' sums in the frame buffer, as digest_of makes it
  std::vector<std::string> layers_sha256;  ///< likewise of the layers, in the order of kLayerNames
};

struct RenderResult {
  Picture picture;            ///< linear radiance
  std::vector<Layer> layers;  ///< those of Quality::layers
  RenderFigures figures;
  std::vector<std::string> notes;  ///< for the user: memory chosen, warnings
};

struct RenderFiles {
  std::optional<std::filesystem::path> save_radiosity;
  std::optional<std::filesystem::path> save_mesh;  ///< PLY with all light, whatever the picture takes from shadow rays
  std::optional<std::filesystem::path> radiosity;  ///< skip the radiosity stage
};

/// Before anything has run.
struct Prediction {
  double load_cycles = 0, radiosity_cycles = 0, ray_tracing_cycles = 0;  ///< virtual time, both loads in one
  double records = 0;                                                    ///< of the radiosity stage
  std::uint64_t shots = 0;
  double rays = 0;                                                                        ///< camera rays
  double packets = 0;                                                                     ///< on the torus
  double instructions = 0;                                                                ///< of all PEs
  double draft_cycles = 0, draft_records = 0, draft_packets = 0, draft_instructions = 0;  ///< of the draft's machine
  double wall_seconds = 0;  ///< of both, on a computer like the one where the engines' speed was measured

  double cycles() const { return draft_cycles + load_cycles + radiosity_cycles + ray_tracing_cycles; }
};

/// What `torolux info` tells: nothing is run.
struct RenderPlan {
  std::uint64_t triangles, patches, elements;
  std::array<std::uint32_t, 3> subspaces;
  std::uint64_t filled_subspaces;
  StageCopies radiosity_copies, ray_tracing_copies;
  std::uint32_t local_memory_needed;    ///< of the fullest PE, both stages
  std::uint32_t local_memory_bytes;     ///< chosen or given
  std::vector<std::uint64_t> pe_bytes;  ///< needed, by PE
  Prediction prediction;
  double mean_neighbour_hops;         ///< torus distance between face-adjacent subspaces
  std::vector<std::string> refusals;  ///< empty: it would run
  std::vector<std::string> notes;
};

/// pe_image: pe.elf. Throws InputError (does not fit, ...), MachineFailure. progress returns false: stop (Ctrl-C).
RenderResult render(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                    const RenderFiles& files, const std::filesystem::path& pe_image,
                    const std::function<bool(const RenderProgress&)>& progress);

RenderPlan plan(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                const std::filesystem::path& pe_image);

}  // namespace torolux
