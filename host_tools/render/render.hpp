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
#include "host_tools/checkpoint/checkpoint_file.hpp"
#include "host_tools/checkpoint/keeper.hpp"
#include "host_tools/layout/copies.hpp"
#include "host_tools/picture/layers.hpp"
#include "host_tools/picture/picture.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/settings/machine_choice.hpp"
#include "host_tools/settings/quality.hpp"
#include "host_tools/solution/solution.hpp"
#include "host_tools/stages/progress.hpp"
#include "host_tools/stages/rounds.hpp"

namespace torolux {

/// One of a path's pictures.
struct PathFrame {
  Cycles cycles = 0;   ///< of virtual time; the first: all stages before it, too
  std::string sha256;  ///< as picture_sha256
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
  std::uint64_t memory_needed = 0;       ///< of the fullest PE, copies included [bytes]
  double mean_memory_needed = 0;         ///< of all PEs [bytes]
  std::array<std::uint32_t, 3> subspaces{};
  std::uint64_t filled_subspaces = 0;                ///< with anything in them
  StageCopies radiosity_copies, ray_tracing_copies;  ///< of those
  std::string picture_sha256;              ///< of the colours' sums in the frame buffer, as digest_of makes it
  std::vector<std::string> layers_sha256;  ///< likewise of the layers, in the order of kLayerNames
  std::vector<PathFrame> path;             ///< of --path; all other figures are of its first picture alone
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
  CheckpointChoice checkpoint = {};                ///< what is kept of the run meanwhile
  /// Called where the run ends by Ctrl-C while rays are traced, after its state has been saved: the picture as far as
  /// it is; black where it is not. Null: nobody wants it.
  std::function<void(const Picture&)> picture_so_far = {};
  CheckpointReader* resume = nullptr;  ///< go on from there; of a run with the same settings
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
