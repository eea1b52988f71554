// SPDX-License-Identifier: MIT
// A run's description enters, the block `settings` of its statistics leaves.
#include "host_tools/report/settings_json.hpp"

#include <nlohmann/json.hpp>

#include "host_tools/report/text.hpp"
#include "host_tools/report/version.hpp"
#include "host_tools/scene/camera.hpp"
#include "host_tools/settings/options.hpp"
#include "host_tools/settings/overloaded.hpp"

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

template <class Value>
Json value_or_auto(const std::optional<Value>& value) {
  return value ? Json(*value) : Json("auto");
}

Json option_json(const Option& option, const AllSettings& settings) {
  return std::visit(Overloaded{
                        [&](const option::Choice& kind) { return Json(kind.names.at(kind.member.of(settings))); },
                        [&](const option::White& kind) {
                          const WhiteBalance& white = kind.member.of(settings);
                          return white.kind == WhiteBalance::Kind::kelvin ? Json(white.kelvin)
                                                                          : Json(value_text(option, settings));
                        },
                        [&](const option::Length& kind) { return value_or_auto(kind.member.of(settings)); },
                        [&](const option::Fraction& kind) { return value_or_auto(kind.member.of(settings)); },
                        [&](const option::Memory& kind) { return value_or_auto(kind.member.of(settings)); },
                        [&](const option::Cells& kind) { return value_or_auto(kind.member.of(settings)); },
                        [&](const option::Layers& kind) {
                          Json names = Json::array();
                          for (const LayerName& layer : layers_in(kind.member.of(settings)))
                            names.push_back(layer.name);
                          return names;
                        },
                        [&](const auto& kind) { return Json(kind.member.of(settings)); },
                    },
                    option.kind);
}

/// The options `among` which the option is, in the order of the table.
template <class Among>
void add_options(Json& json, const AllSettings& settings, Among among) {
  for (const Option& option : all_options()) {
    if (!option.key.empty() && among(option)) json[option.key] = option_json(option, settings);
  }
}

void add_camera(Json& json, const RunDescription& run) {
  json["camera"] = {{"eye", run.camera.eye},
                    {"look_at", run.camera.look_at},
                    {"up", run.camera.up},
                    {"field_of_view", run.camera.field_of_view_degrees},
                    {"aperture", run.camera.aperture}};
  if (run.camera.aperture > 0) json["camera"]["focus"] = focus_distance(run.camera);
  if (run.inputs.studio) json["camera"]["given"] = run.inputs.camera_given;
}

/// Their place in the statistics is after those that were there before them.
bool comes_late(const Option& option) {
  return option.key == "texels" || option.key == "two_sided_lights" || option.key == "seed";
}

void add_picture(Json& json, const RunDescription& run, const AllSettings& settings) {
  add_options(json, settings,
              [](const Option& option) { return option.group == OptionGroup::results && option.key != "layers"; });
  json["quality"] = run.preset;
  const auto bears = [](const Option& option) {
    return option.group == OptionGroup::view || option.group == OptionGroup::quality || option.key == "layers";
  };
  add_options(json, settings, [&](const Option& option) { return bears(option) && !comes_late(option); });
  add_options(json, settings, [&](const Option& option) { return bears(option) && comes_late(option); });
}

void add_machine(Json& json, const AllSettings& settings, const RenderFigures* figures) {
  const MachineChoice& machine = settings.machine;
  json["pes"] = {machine.columns, machine.rows};
  if (figures != nullptr || machine.pe_memory)
    json["pe_memory"] = figures != nullptr ? figures->local_memory_bytes : *machine.pe_memory;
  if (figures != nullptr || machine.subspaces)
    json["subspaces"] = figures != nullptr ? figures->subspaces : *machine.subspaces;
  json["automatic"] = Json::array();
  if (!machine.pe_memory) json["automatic"].push_back("pe_memory");
  if (!machine.subspaces) json["automatic"].push_back("subspaces");
  add_options(json, settings, [](const Option& option) { return option.group == OptionGroup::machine; });
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
  if (run.inputs.gltf_in_lumens) json["gltf_units"] = "lumen";
  if (!run.inputs.camera_name.empty()) json["camera_name"] = run.inputs.camera_name;
  json["inputs"] = inputs_json(run.inputs.files);
  const AllSettings settings{run.quality, run.tone, run.machine};
  add_camera(json, run);
  add_picture(json, run, settings);
  add_machine(json, settings, figures);
  return json;
}

Json settings_json(const MachineSetup& setup, const ProgramFiles& inputs) {
  Json json;
  json["command"] = "run";
  json["versions"] = versions_json();
  json["engine"] = setup.engine;
  const std::vector<InputFile>& images = inputs.images.files;
  if (images.size() == 1) json["image"] = images.front().path;
  std::vector<InputFile> files = images;
  files.insert(files.end(), inputs.read.begin(), inputs.read.end());
  json["inputs"] = inputs_json(files);
  for (std::uint32_t file = 0; images.size() > 1 && file < images.size(); ++file)
    json["images"].push_back({{"pes", ranges(inputs.images.pes_of(file))}, {"input", file}});
  if (!inputs.outputs.empty()) json["outputs"] = inputs.outputs;
  if (!setup.arguments.empty()) json["arguments"] = setup.arguments;
  json["pes"] = {setup.columns, setup.rows};
  json["pe_memory"] = setup.local_memory_bytes;
  if (setup.until != 0) json["until"] = setup.until;
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
