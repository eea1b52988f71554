// SPDX-License-Identifier: MIT
// Options and a scene enter, complete settings leave.
#include "host_tools/cli/settle.hpp"

#include "emulator/errors.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/scene/load_scene.hpp"

namespace torolux {
namespace {

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

Quality settle_quality(const RenderOptions& options, const SceneDefaults& defaults) {
  Quality quality;
  const auto edge = [&](std::size_t i) { return options.size ? std::optional((*options.size)[i]) : std::nullopt; };
  pick(quality.width, edge(0), defaults.width);
  pick(quality.height, edge(1), defaults.height);
  pick(quality.samples, options.samples, defaults.samples);
  quality.patch_length = options.patches ? options.patches->length : defaults.patch_length;
  quality.element_length = options.elements ? options.elements->length : defaults.element_length;
  pick(quality.refine, options.refine, defaults.refine);
  if (!options.filter && defaults.filter)
    from_scene(defaults.filter_place, "filter", [&] { quality.filter = parse_filter(*defaults.filter); });
  quality.filter = options.filter.value_or(quality.filter);
  quality.layers = options.layers;
  pick(quality.hemicube, options.hemicube, defaults.hemicube);
  pick(quality.shot_points, options.shot_points, defaults.shot_points);
  pick(quality.emission_records, options.emission_records, defaults.emission_records);
  pick(quality.unshot, options.unshot, defaults.unshot);
  pick(quality.max_shots, options.max_shots, defaults.max_shots);
  pick(quality.bounces, options.bounces, defaults.bounces);
  pick(quality.shadow_rays, options.shadow_rays, defaults.shadow_rays);
  pick(quality.texels, options.texels, defaults.texels);
  pick(quality.seed, options.seed, defaults.seed);
  quality.two_sided_lights = options.two_sided_lights || defaults.two_sided_lights.value_or(false);
  return quality;
}

MachineChoice settle_machine(const RenderOptions& options, const Scene& scene) {
  MachineChoice machine;
  if (options.machine) machine.description = load_machine_description(*options.machine);
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
  settled.quality = settle_quality(options, scene.defaults);
  settled.machine = settle_machine(options, scene);
  pick(settled.tone.exposure_ev, options.tone.exposure_ev, scene.defaults.exposure_ev);
  settled.tone.curve = options.tone.curve.value_or(ToneCurve::filmic);
  settled.outputs = options.outputs;
  if (settled.outputs.empty()) settled.outputs.emplace_back(scene.name + ".png");
  settled.files = {options.save_radiosity, options.radiosity};
  return settled;
}

}  // namespace torolux
