// SPDX-License-Identifier: MIT
// A run's description enters, the block `settings` of its statistics leaves.
#include "host_tools/report/settings_json.hpp"

#include <nlohmann/json.hpp>

#include "host_tools/report/version.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

Json versions_json() {
  const std::string commit = program_commit();
  return {{"program", kVersion},
          {"commit", commit.empty() ? Json() : Json(commit)},
          {"protocol", protocol::kProtocolVersion},
          {"statistics", kStatisticsVersion}};
}

Json inputs_json(const std::vector<InputFile>& files) {
  Json inputs = Json::array();
  for (const InputFile& file : files)
    inputs.push_back({{"role", file.role}, {"path", file.path}, {"sha256", file.sha256}});
  return inputs;
}

/// Tables as in a machine file.
Json machine_json(const MachineDescription& description) {
  Json machine = Json::object();
  for (const MachineSetting& setting : machine_description_values(description)) {
    Json* table = &machine;
    std::string_view key = setting.key;
    for (std::size_t dot = key.find('.'); dot != std::string_view::npos; dot = key.find('.')) {
      table = &(*table)[std::string(key.substr(0, dot))];
      key.remove_prefix(dot + 1);
    }
    std::visit([&](const auto& value) { (*table)[std::string(key)] = value; }, setting.value);
  }
  return machine;
}

Json layer_names(LayerSet set) {
  Json names = Json::array();
  for (const LayerName& layer : layers_in(set)) names.push_back(layer.name);
  return names;
}

template <class Value>
Json value_or_auto(const std::optional<Value>& value) {
  return value ? Json(*value) : Json("auto");
}

void add_view(Json& json, const RunDescription& run) {
  json["camera"] = {{"eye", run.camera.eye},
                    {"look_at", run.camera.look_at},
                    {"up", run.camera.up},
                    {"field_of_view", run.camera.field_of_view_degrees}};
  if (run.inputs.studio) json["camera"]["given"] = run.inputs.camera_given;
  json["exposure"] = run.tone.exposure_ev;
  json["tone_curve"] = run.tone.curve == ToneCurve::filmic ? "filmic" : "linear";
}

void add_quality(Json& json, const RunDescription& run) {
  const Quality& quality = run.quality;
  json["quality"] = run.preset;
  json["width"] = quality.width;
  json["height"] = quality.height;
  json["samples"] = quality.samples;
  json["filter"] = name_of(quality.filter);
  json["layers"] = layer_names(quality.layers);
  json["patches"] = value_or_auto(quality.patch_length);
  json["elements"] = value_or_auto(quality.element_length);
  json["patch_factor"] = quality.patch_factor;
  json["element_factor"] = quality.element_factor;
  json["cluster_factor"] = quality.cluster_factor;
  json["refine"] = quality.refine;
  json["hemicube"] = quality.hemicube;
  json["shot_points"] = quality.shot_points;
  json["emission_records"] = quality.emission_records;
  json["unshot"] = quality.unshot;
  json["max_shots"] = quality.max_shots;
  json["bounces"] = quality.bounces;
  json["direct"] = quality.shadow_rays ? "shadow-rays" : "radiosity";
  json["texels"] = quality.texels;
  json["two_sided_lights"] = quality.two_sided_lights;
  json["seed"] = quality.seed;
}

void add_machine(Json& json, const RunDescription& run, const RenderFigures* figures) {
  const MachineChoice& machine = run.machine;
  json["pes"] = {machine.columns, machine.rows};
  if (figures != nullptr || machine.pe_memory)
    json["pe_memory"] = figures != nullptr ? figures->local_memory_bytes : *machine.pe_memory;
  if (figures != nullptr || machine.subspaces)
    json["subspaces"] = figures != nullptr ? figures->subspaces : *machine.subspaces;
  json["automatic"] = Json::array();
  if (!machine.pe_memory) json["automatic"].push_back("pe_memory");
  if (!machine.subspaces) json["automatic"].push_back("subspaces");
  json["scheme"] = name_of(machine.scheme);
  json["allocation"] = machine.allocation;
  json["replicate"] = value_or_auto(machine.replicate);
  json["points"] = name_of(machine.points);
  json["empty"] = name_of(machine.empty);
  json["camera_rays"] = name_of(machine.camera_rays);
  json["skip_empty_subspaces"] = machine.skip_empty_subspaces;
  if (!machine.debugging.qemu_pes.empty()) json["qemu_pes"] = machine.debugging.qemu_pes;
  json["machine"] = machine_json(machine.description);
}

}  // namespace

Json settings_json(const RunDescription& run, const RenderFigures* figures) {
  Json json;
  json["command"] = "render";
  json["versions"] = versions_json();
  json["engine"] = run.machine.engine;
  json["scene"] = run.scene;
  json["scene_path"] = run.inputs.scene_path;
  json["studio"] = run.inputs.studio;
  if (run.inputs.missing_are_white) json["missing_materials"] = "white";
  json["inputs"] = inputs_json(run.inputs.files);
  add_view(json, run);
  add_quality(json, run);
  add_machine(json, run, figures);
  return json;
}

Json settings_json(const MachineSetup& setup, const InputFile& image) {
  Json json;
  json["command"] = "run";
  json["versions"] = versions_json();
  json["engine"] = setup.engine;
  json["image"] = image.path;
  json["inputs"] = inputs_json({image});
  json["pes"] = {setup.columns, setup.rows};
  json["pe_memory"] = setup.local_memory_bytes;
  if (!setup.debugging.qemu_pes.empty()) json["qemu_pes"] = setup.debugging.qemu_pes;
  json["machine"] = machine_json(setup.description);
  return json;
}

Json determining(Json settings) {
  if (const auto automatic = settings.find("automatic"); automatic != settings.end()) {
    for (const Json& key : Json(*automatic)) settings.erase(key.get<std::string>());
  }
  for (const char* name : {"versions", "scene", "scene_path", "image"}) settings.erase(name);
  for (Json& input : settings["inputs"]) input.erase("path");
  return settings;
}

}  // namespace torolux
