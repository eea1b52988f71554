// SPDX-License-Identifier: MIT
// Options and a scene enter, complete settings leave.
#include "host_tools/cli/settle.hpp"

#include <algorithm>

#include "emulator/errors.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/scene/load_scene.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Of the scene's surface, beyond which presets choose no shadow rays: large emitters cast no sharp shadows, and what
/// lies near to them gets very unequal shares from rays to points that are spread over them evenly.
constexpr double kMostEmittingShare = 0.125;

/// An option given > the scene's default > the built-in value that `value` holds already.
template <class Value, class Given, class Suggested>
void pick(Value& value, const std::optional<Given>& given, const std::optional<Suggested>& suggested) {
  if (given)
    value = static_cast<Value>(*given);
  else if (suggested)
    value = static_cast<Value>(*suggested);
}

/// Runs `take` on a value of the scene; what it refuses is the scene's fault.
template <class Take>
void from_scene(const std::string& place, const char* key, Take take) {
  try {
    take();
  } catch (const std::runtime_error& error) {
    throw InputError(place + ": [defaults] '" + key + "': " + error.what());
  }
}

Camera settle_camera(const RenderOptions& options, const Scene& scene) {
  Camera camera = scene.camera.value_or(Camera{});
  if (options.eye) camera.eye = *options.eye;
  if (options.look_at) camera.look_at = *options.look_at;
  if (options.up) camera.up = *options.up;
  if (options.field_of_view_degrees) camera.field_of_view_degrees = *options.field_of_view_degrees;
  check_camera(camera);
  return camera;
}

/// Returns the preset at which the scene's settings hold.
Preset take_scenes(const SceneDefaults& defaults, Quality& quality) {
  Preset preset = *preset_named("normal");
  if (defaults.quality) {
    from_scene(defaults.quality_place, "quality", [&] { preset = parse_preset(*defaults.quality); });
    apply(preset, quality);
  }
  if (defaults.filter)
    from_scene(defaults.filter_place, "filter", [&] { quality.filter = parse_filter(*defaults.filter); });
  const auto take = [](auto& value, const auto& scenes) { value = scenes.value_or(value); };
  take(quality.width, defaults.width);
  take(quality.height, defaults.height);
  take(quality.samples, defaults.samples);
  take(quality.refine, defaults.refine);
  take(quality.hemicube, defaults.hemicube);
  take(quality.shot_points, defaults.shot_points);
  take(quality.emission_records, defaults.emission_records);
  take(quality.unshot, defaults.unshot);
  take(quality.max_shots, defaults.max_shots);
  take(quality.bounces, defaults.bounces);
  take(quality.shadow_rays, defaults.shadow_rays);
  take(quality.texels, defaults.texels);
  take(quality.seed, defaults.seed);
  take(quality.two_sided_lights, defaults.two_sided_lights);
  return preset;
}

void take_options(const RenderOptions& options, Quality& quality) {
  const auto take = [](auto& value, const auto& given) { value = given.value_or(value); };
  if (options.size) {
    quality.width = (*options.size)[0];
    quality.height = (*options.size)[1];
  }
  take(quality.samples, options.samples);
  take(quality.refine, options.refine);
  take(quality.filter, options.filter);
  quality.layers = options.layers;
  take(quality.hemicube, options.hemicube);
  take(quality.shot_points, options.shot_points);
  take(quality.emission_records, options.emission_records);
  take(quality.unshot, options.unshot);
  take(quality.max_shots, options.max_shots);
  take(quality.bounces, options.bounces);
  take(quality.shadow_rays, options.shadow_rays);
  take(quality.texels, options.texels);
  take(quality.seed, options.seed);
  quality.two_sided_lights = quality.two_sided_lights || options.two_sided_lights;
}

/// Share of the scene's surface.
double emitting_share(const Scene& scene) {
  double all = 0;
  double emitting = 0;
  for (const SceneTriangle& triangle : scene.triangles) {
    const auto& [a, b, c] = triangle.position;
    const Vec3d& corner = scene.positions[a];
    const double area =
        vec::length(vec::cross(vec::subtract(scene.positions[b], corner), vec::subtract(scene.positions[c], corner)));
    all += area;
    if (emits(scene.materials[triangle.material])) emitting += area;
  }
  return emitting / all;
}

void settle_quality(const RenderOptions& options, const Scene& scene, Quality& quality, std::string& preset) {
  const SceneDefaults& defaults = scene.defaults;
  const Preset scenes_preset = take_scenes(defaults, quality);
  preset = options.preset.value_or(scenes_preset).name;
  if (options.preset) change_preset(scenes_preset, *options.preset, quality);
  if (quality.shadow_rays && !defaults.shadow_rays && emitting_share(scene) > kMostEmittingShare)
    quality.shadow_rays = false;
  take_options(options, quality);
  // A preset makes the scene's own lengths shorter or longer; one that is given holds.
  const auto length = [](const std::optional<LengthOption>& given, const std::optional<double>& scenes, double factor) {
    if (given) return given->length;
    return scenes ? std::optional(*scenes * factor) : std::nullopt;
  };
  quality.patch_length = length(options.patches, defaults.patch_length, quality.patch_factor);
  quality.element_length = length(options.elements, defaults.element_length, quality.element_factor);
  // What is not refined is as fine as patches are, or as elements that are given.
  quality.cluster_factor = options.elements ? 1 : std::min(1.0, quality.patch_factor / quality.element_factor);
}

MachineChoice settle_machine(const RenderOptions& options, const Scene& scene) {
  MachineChoice machine;
  if (options.machine) machine.description = load_machine_description(*options.machine);
  for (const std::string& value : options.machine_values) set_machine_value(machine.description, value);
  machine.description.ideal = either(machine.description.ideal, options.ideal);
  options.faults.apply_to(machine.description);
  if (options.pes) {
    machine.columns = (*options.pes)[0];
    machine.rows = (*options.pes)[1];
  }
  machine.pe_memory = options.pe_memory;
  if (options.subspaces)
    machine.subspaces = options.subspaces->cells;
  else if (scene.defaults.subspaces)
    from_scene(scene.defaults.subspaces_place, "subspaces",
               [&] { machine.subspaces = parse_subspaces(*scene.defaults.subspaces); });
  take_scheme(machine, options.scheme.value_or(machine.scheme));
  if (options.replicate) machine.replicate = options.replicate->fraction;
  machine.points = options.points.value_or(machine.points);
  machine.empty = options.empty.value_or(machine.empty);
  machine.camera_rays = options.camera_rays.value_or(machine.camera_rays);
  if (!options.allocation && scene.defaults.allocation)
    from_scene(scene.defaults.allocation_place, "allocation", [&] { check_allocation(*scene.defaults.allocation); });
  pick(machine.allocation, options.allocation, scene.defaults.allocation);
  machine.skip_empty_subspaces = !options.enter_empty;
  if (options.engine) machine.engine = *options.engine;
  machine.debugging = options.debugging;
  machine.threads = options.threads.value_or(0);
  return machine;
}

}  // namespace

SceneOptions scene_options(const RenderOptions& options) {
  SceneOptions result;
  result.studio = options.studio;
  result.missing_materials = options.missing_materials;
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

Settled settle(const RenderOptions& options, const Scene& scene) {
  Settled settled;
  settled.camera = settle_camera(options, scene);
  settle_quality(options, scene, settled.quality, settled.preset);
  settled.machine = settle_machine(options, scene);
  pick(settled.tone.exposure_ev, options.tone.exposure_ev, scene.defaults.exposure_ev);
  settled.tone.curve = options.tone.curve.value_or(ToneCurve::filmic);
  settled.outputs = options.outputs;
  if (options.no_picture && !settled.outputs.empty()) throw UsageError("--no-picture and --output exclude each other");
  if (settled.outputs.empty() && !options.no_picture) settled.outputs.emplace_back(scene.name + ".png");
  settled.files = {options.save_radiosity, options.save_mesh, options.radiosity};
  return settled;
}

RunDescription describe(const RenderOptions& options, const Settled& settled, const std::string& scene_name,
                        std::vector<InputFile> files) {
  RunDescription run;
  run.scene = scene_name;
  run.quality = settled.quality;
  run.machine = settled.machine;
  run.pictures = settled.outputs;
  run.preset = settled.preset;
  run.camera = settled.camera;
  run.tone = settled.tone;
  run.inputs = {options.scene.string(),
                options.studio,
                options.missing_materials == MissingMaterials::white,
                {},
                std::move(files)};
  const auto given = [&](const auto& value, const char* name) {
    if (value) run.inputs.camera_given.emplace_back(name);
  };
  given(options.eye, "eye");
  given(options.look_at, "look_at");
  given(options.up, "up");
  given(options.field_of_view_degrees, "field_of_view");
  return run;
}

}  // namespace torolux
