// SPDX-License-Identifier: MIT
// The options of `torolux render` and `torolux info` as the user gave them; what was not given is absent.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "emulator/engines/engine/debugging.hpp"
#include "host_tools/camera/pixel_samples.hpp"
#include "host_tools/cli/fault_options.hpp"
#include "host_tools/cli/ideal_option.hpp"
#include "host_tools/cli/trace_options.hpp"
#include "host_tools/picture/layers.hpp"
#include "host_tools/scene/missing_materials.hpp"
#include "host_tools/settings/presets.hpp"
#include "host_tools/settings/scheme.hpp"

namespace CLI {
class App;
}

namespace torolux {

/// A length, or `auto` (absent). An option that was given as `auto` outweighs a scene's own length.
struct LengthOption {
  std::optional<double> length;
};
struct SubspacesOption {
  std::optional<std::array<std::uint32_t, 3>> cells;
};
struct ReplicateOption {
  std::optional<double> fraction;  ///< of a PE's memory; absent: as much as fits
};

/// --exposure and --tone-curve.
struct ToneOptions {
  std::optional<double> exposure_ev;
  std::optional<ToneCurve> curve;
};

struct RenderOptions {
  std::filesystem::path scene;
  bool studio = false;
  MissingMaterials missing_materials = MissingMaterials::refuse;
  bool strict = false;

  // What comes out.
  std::vector<std::filesystem::path> outputs;
  bool no_picture = false;
  ToneOptions tone;
  LayerSet layers = 0;
  std::optional<std::filesystem::path> save_radiosity, save_mesh, radiosity, stats, stats_csv, report;
  TraceOptions trace;
  bool quiet = false, verbose = false;

  // The view.
  std::optional<std::array<std::uint32_t, 2>> size;
  std::optional<std::uint32_t> samples;
  std::optional<PixelFilter> filter;
  std::optional<std::array<double, 3>> eye, look_at, up;
  std::optional<double> field_of_view_degrees;

  // The light.
  std::optional<Preset> preset;
  std::optional<LengthOption> patches, elements;
  std::optional<std::uint32_t> hemicube, shot_points, emission_records, max_shots, bounces, texels;
  std::optional<double> refine, unshot;
  std::optional<std::uint64_t> seed;
  bool two_sided_lights = false;
  std::optional<bool> shadow_rays;

  // The machine.
  std::optional<std::array<std::uint32_t, 2>> pes;
  std::optional<std::uint32_t> pe_memory;
  std::optional<SubspacesOption> subspaces;
  std::optional<Scheme> scheme;
  std::optional<ReplicateOption> replicate;
  std::optional<Points> points;
  std::optional<Empty> empty;
  std::optional<RayMaker> camera_rays;
  std::optional<std::string> allocation, engine;
  Debugging debugging;
  FaultOptions faults;
  MachineDescription::Ideal ideal;
  bool enter_empty = false;
  std::optional<std::filesystem::path> machine;
  std::vector<std::string> machine_values;  ///< KEY=VALUE, checked, in the order given
  std::optional<std::uint32_t> threads;
};

/// SCENE, --studio, --missing-materials, --strict. name, help: of the first.
void add_scene_options(CLI::App& command, RenderOptions& options, const std::string& name = "SCENE",
                       const std::string& help = "A folder with scene.toml, a .toml file, or an .obj file");
/// --exposure, --tone-curve.
void add_tone_options(CLI::App& command, ToneOptions& options, const std::string& group);
/// --output, --no-picture, --layers, --exposure, --tone-curve, --stats, --stats-csv, --report, --save-radiosity,
/// --save-mesh, --radiosity, --quiet, --verbose.
void add_output_options(CLI::App& command, RenderOptions& options);
/// --size, --samples, --filter, --eye, --look-at, --up, --fov.
void add_view_options(CLI::App& command, RenderOptions& options);
/// --quality, --patches, --elements, --refine, --hemicube, --shot-points, --unshot, --max-shots, --bounces,
/// --two-sided-lights,
/// --seed.
void add_light_options(CLI::App& command, RenderOptions& options);
/// --set: KEY=VALUE of the machine's parameters, checked, into `values`.
void add_machine_values_option(CLI::App& command, std::vector<std::string>& values, const std::string& group);
/// --pes, --pe-memory, --subspaces, --scheme, --allocation, --replicate, --points, --empty, --camera-rays,
/// --enter-empty, --machine, --set, --ideal, --jitter, --fault, --threads.
void add_machine_options(CLI::App& command, RenderOptions& options);
/// --engine.
void add_engine_option(CLI::App& command, RenderOptions& options);

/// Their group in --help.
inline constexpr const char* kMachineGroup = "Machine (does not change the picture)";

/// Throws UsageError unless `name` is an allocation; the message lists them all.
void check_allocation(const std::string& name);

}  // namespace torolux
