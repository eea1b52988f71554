// SPDX-License-Identifier: MIT
// The options of `torolux render` and `torolux info` as the user gave them; what was not given is absent.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "emulator/engines/engine/debugging.hpp"
#include "host_tools/cli/checkpoint_options.hpp"
#include "host_tools/cli/display_options.hpp"
#include "host_tools/cli/fault_options.hpp"
#include "host_tools/cli/ideal_option.hpp"
#include "host_tools/cli/rank_options.hpp"
#include "host_tools/cli/trace_options.hpp"
#include "host_tools/growing_picture/growing_picture.hpp"
#include "host_tools/scene/gltf_units.hpp"
#include "host_tools/scene/missing_materials.hpp"
#include "host_tools/settings/given_settings.hpp"
#include "host_tools/settings/presets.hpp"
#include "host_tools/trace/follow_target.hpp"

namespace CLI {
class App;
}

namespace torolux {

struct RenderOptions {
  GivenSettings given;  ///< the options of the table

  std::filesystem::path scene;
  bool studio = false;
  MissingMaterials missing_materials = MissingMaterials::refuse;
  GltfUnits gltf_units = GltfUnits::watt;
  bool strict = false;

  // What comes out.
  std::vector<std::filesystem::path> outputs;
  bool no_picture = false;
  std::optional<std::filesystem::path> save_radiosity, save_mesh, radiosity, stats, stats_csv, report, profile;
  GrowingPictureChoice growing;
  TraceOptions trace;
  DisplayOptions display;
  CheckpointOptions checkpoint;
  std::optional<FollowTarget> follow;
  bool quiet = false, verbose = false;

  // The view.
  std::optional<std::array<double, 3>> eye, look_at, up;
  std::optional<double> field_of_view_degrees, aperture;
  std::optional<std::variant<double, std::array<double, 3>>> focus;
  std::string camera_name;                    ///< of a camera that a mesh brings along
  std::optional<std::filesystem::path> path;  ///< cameras of an animation

  // The light.
  std::optional<Preset> preset;

  // The machine.
  Debugging debugging;
  RankOptions ranks;
  FaultOptions faults;
  MachineDescription::Ideal ideal;
  std::optional<std::filesystem::path> machine;
  std::vector<std::string> machine_values;  ///< KEY=VALUE, checked, in the order given
};

/// SCENE, --studio, --missing-materials, --gltf-units, --strict. name, help: of the first.
void add_scene_options(
    CLI::App& command, RenderOptions& options, const std::string& name = "SCENE",
    const std::string& help =
        "A folder with scene.toml, a .toml, .obj, .gltf, .glb or .mgf file, or the name of a scene that came with "
        "the program");
/// --exposure, --tone-curve, --white-balance.
void add_tone_options(CLI::App& command, GivenSettings& given, const std::string& group);
/// Those of the table's groups, and what is by their side: files, the camera, --quality, the machine's parameters.
void add_output_options(CLI::App& command, RenderOptions& options);
void add_view_options(CLI::App& command, RenderOptions& options);
void add_light_options(CLI::App& command, RenderOptions& options);
void add_machine_options(CLI::App& command, RenderOptions& options);
/// --engine.
void add_engine_option(CLI::App& command, RenderOptions& options);
/// --set: KEY=VALUE of the machine's parameters, checked, into `values`.
void add_machine_values_option(CLI::App& command, std::vector<std::string>& values, const std::string& group);

}  // namespace torolux
