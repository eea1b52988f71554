// SPDX-License-Identifier: MIT
// Options and a scene enter, complete settings leave.
#include "host_tools/cli/resolve.hpp"

#include <algorithm>
#include <utility>

#include "emulator/errors.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/path_frames.hpp"
#include "host_tools/cli/table_options.hpp"
#include "host_tools/scene/load_scene.hpp"
#include "host_tools/scene/surface_shares.hpp"

namespace torolux {
namespace {

/// Of the scene's surface, beyond which presets choose no final gathering: light that mirrors, glass and lobes have
/// turned is left to records, of which there are fewer with it.
constexpr double kMostTurningShare = 0.01;

/// Runs `take` on a text of the scene; what it refuses is the scene's fault.
template <class Take>
void from_scene(const PlacedText& text, const char* key, Take take) {
  try {
    take(text.text);
  } catch (const std::runtime_error& error) {
    throw InputError(text.place + ": [defaults] '" + key + "': " + error.what());
  }
}

/// A path's cameras; none where there is no path.
std::vector<Camera> resolve_path(const RenderOptions& options, const Scene& scene) {
  if (!options.path) return {};
  if (options.eye || options.look_at || options.up || options.field_of_view_degrees || options.aperture ||
      options.focus) {
    throw UsageError(
        "--path says where the camera is: leave out --eye, --look-at, --up, --fov, --aperture and --focus");
  }
  return load_camera_path(*options.path, scene.camera.value_or(Camera{}));
}

Camera resolve_camera(const RenderOptions& options, const Scene& scene) {
  Camera camera = scene.camera.value_or(Camera{});
  if (options.eye) camera.eye = *options.eye;
  if (options.look_at) camera.look_at = *options.look_at;
  if (options.up) camera.up = *options.up;
  if (options.field_of_view_degrees) camera.field_of_view_degrees = *options.field_of_view_degrees;
  if (options.aperture) camera.aperture = *options.aperture;
  if (options.focus) camera.focus = options.focus;
  check_camera(camera);
  return camera;
}

/// The preset at which the scene's settings hold.
Preset preset_of(const SceneDefaults& defaults) {
  Preset preset = *preset_named("normal");
  if (defaults.quality) {
    from_scene(*defaults.quality, "quality", [&preset](const std::string& text) { preset = parse_preset(text); });
  }
  return preset;
}

/// Whether presets have final gathering: where hardly any surface turns light. Who says how many records or shots there
/// are to be, or that elements are not to gather, has a preset without.
bool presets_gather(const GivenSettings& scenes, const GivenSettings& users, const Scene& scene) {
  const auto given = [&](auto member) {
    const auto by_user = users.get(member);
    return by_user ? by_user : scenes.get(member);
  };
  const bool shots_given =
      given(&Quality::shot_points) || given(&Quality::emission_records) || given(&Quality::max_shots).value_or(0) > 0;
  const bool wanted = given(&Quality::final_gather).value_or(shots_given ? 0 : 1) != 0;
  return wanted && turning_share(scene) <= kMostTurningShare;
}

/// A preset makes the scene's own lengths shorter or longer; one that is given holds.
void scale_lengths(const GivenSettings& given, Quality& quality) {
  const auto scale = [&](std::optional<double> Quality::*length, double factor) {
    if (quality.*length && !given.has(length)) *(quality.*length) *= factor;
  };
  scale(&Quality::patch_length, quality.patch_factor);
  scale(&Quality::element_length, quality.element_factor);
  // What is not refined is as fine as patches are, or as elements that are given.
  const bool elements_given = given.has(&Quality::element_length);
  quality.cluster_factor = elements_given ? 1 : std::min(1.0, quality.patch_factor / quality.element_factor);
}

MachineDescription resolve_description(const RenderOptions& options) {
  MachineDescription description;
  if (options.machine) description = load_machine_description(*options.machine);
  for (const std::string& value : options.machine_values) set_machine_value(description, value);
  description.ideal = either(description.ideal, options.ideal);
  options.faults.apply_to(description);
  return description;
}

/// What of the machine a scene suggests and the user does not outweigh.
void take_machine(const SceneDefaults& defaults, const GivenSettings& given, MachineChoice& machine) {
  if (defaults.subspaces && !given.has(&MachineChoice::subspaces)) {
    from_scene(*defaults.subspaces, "subspaces",
               [&machine](const std::string& text) { machine.subspaces = parse_subspaces(text); });
  }
  if (defaults.allocation && !given.has(&MachineChoice::allocation)) {
    from_scene(*defaults.allocation, "allocation", check_allocation);
    machine.allocation = defaults.allocation->text;
  }
}

/// Each setting: given by the user, else by the scene, in the measure of the preset, else built in. Returns the preset
/// that is in force.
std::string resolve_settings(const RenderOptions& options, const Scene& scene, AllSettings& settings) {
  const SceneDefaults& defaults = scene.defaults;
  const bool gather = presets_gather(defaults.given, options.given, scene);
  const auto as_chosen = [gather](const Preset& preset) { return gather ? with_final_gathering(preset) : preset; };
  const Preset scenes_preset = as_chosen(preset_of(defaults));
  apply(scenes_preset, settings.quality);
  defaults.given.apply_to(settings);
  if (options.preset) change_preset(scenes_preset, as_chosen(*options.preset), settings.quality);
  bool& shadow_rays = settings.quality.shadow_rays;
  if (shadow_rays && !defaults.given.has(&Quality::shadow_rays) && has_large_emitters(scene)) shadow_rays = false;
  settings.machine.description = resolve_description(options);
  take_scheme(settings.machine, options.given.values().machine.scheme);
  take_machine(defaults, options.given, settings.machine);
  options.given.apply_to(settings);
  scale_lengths(options.given, settings.quality);
  settings.machine.debugging = options.debugging;
  return std::string(options.preset.value_or(scenes_preset).name);
}

}  // namespace

SceneOptions scene_options(const RenderOptions& options) {
  SceneOptions result;
  result.studio = options.studio;
  result.missing_materials = options.missing_materials;
  result.camera_name = options.camera_name;
  result.gltf_units = options.gltf_units;
  result.strict = options.strict;
  if (!options.eye || !options.look_at) return result;
  Camera camera;
  camera.eye = *options.eye;
  camera.look_at = *options.look_at;
  if (options.up) camera.up = *options.up;
  if (options.field_of_view_degrees) camera.field_of_view_degrees = *options.field_of_view_degrees;
  check_camera(camera);
  result.camera = camera;
  return result;
}

Resolved resolve(const RenderOptions& options, const Scene& scene) {
  Resolved resolved;
  resolved.path = resolve_path(options, scene);
  resolved.camera = resolved.path.empty() ? resolve_camera(options, scene) : resolved.path.front();
  AllSettings settings;
  resolved.preset = resolve_settings(options, scene, settings);
  resolved.quality = settings.quality;
  resolved.machine = std::move(settings.machine);
  resolved.tone = settings.tone;
  resolved.outputs = options.outputs;
  if (resolved.quality.adaptive() && (resolved.path.size() > 1 || options.display.display)) {
    throw UsageError(
        "--most-samples is for one picture: leave it out with --path and --display (or take --most-samples 0, where "
        "the "
        "scene asks for it)");
  }
  if (options.no_picture && !resolved.outputs.empty()) throw UsageError("--no-picture and --output exclude each other");
  if (resolved.outputs.empty() && !options.no_picture) resolved.outputs.emplace_back(scene.name + ".png");
  resolved.files = {options.save_radiosity, options.save_mesh, options.radiosity};
  return resolved;
}

RunDescription describe(const RenderOptions& options, const Resolved& resolved, const std::string& scene_name,
                        std::vector<InputFile> files) {
  RunDescription run;
  run.scene = scene_name;
  run.quality = resolved.quality;
  run.machine = resolved.machine;
  run.pictures = resolved.outputs;
  run.preset = resolved.preset;
  run.camera = resolved.camera;
  run.tone = resolved.tone;
  run.inputs = {options.scene.string(),
                options.studio,
                options.missing_materials == MissingMaterials::white,
                options.gltf_units == GltfUnits::lumen,
                options.camera_name,
                {},
                std::move(files)};
  const auto given = [&](const auto& value, const char* name) {
    if (value) run.inputs.camera_given.emplace_back(name);
  };
  given(options.eye, "eye");
  given(options.look_at, "look_at");
  given(options.up, "up");
  given(options.field_of_view_degrees, "field_of_view");
  given(options.aperture, "aperture");
  if (resolved.camera.aperture > 0) given(options.focus, "focus");
  return run;
}

}  // namespace torolux
