// SPDX-License-Identifier: MIT
// The block `settings` of a run's statistics enters, the command line that leads to it again leaves.
#include <nlohmann/json.hpp>

#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "host_tools/report/settings_json.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

/// Beneath this --unshot takes none: then it is the scene's own, and the preset's.
constexpr double kLeastUnshotOption = 1e-9;

std::string text(const Json& value) {
  if (value.is_number_float()) return text_of(MachineValue(value.get<double>()));
  if (value.is_number()) return value.dump();
  return value.get<std::string>();
}

/// [4, 2] -> "4x2".
std::string joined(const Json& values, char separator) {
  std::string result;
  for (const Json& value : values) result += (result.empty() ? "" : std::string(1, separator)) + text(value);
  return result;
}

void add(Words& words, const std::string& option, const std::string& value) {
  words.push_back(option);
  words.push_back(value);
}

/// A camera of the user's own decides how a studio is built around it: what the user did not give is left out there.
void add_camera(Words& words, const Json& camera) {
  constexpr std::array<std::array<const char*, 2>, 4> kOptions{
      {{"eye", "--eye"}, {"look_at", "--look-at"}, {"up", "--up"}, {"field_of_view", "--fov"}}};
  for (const auto& [key, option] : kOptions) {
    if (const auto given = camera.find("given"); given != camera.end()) {
      if (std::find(given->begin(), given->end(), Json(key)) == given->end()) continue;
    }
    const Json& value = camera.at(key);
    add(words, option, value.is_array() ? joined(value, ',') : text(value));
  }
}

void add_quality(Words& words, const Json& settings) {
  add(words, "--quality", text(settings.at("quality")));
  add(words, "--size", text(settings.at("width")) + "x" + text(settings.at("height")));
  if (const Json& layers = settings.at("layers"); !layers.empty()) add(words, "--layers", joined(layers, ','));
  add(words, "--patches", text(settings.at("patches")));
  // Elements that are given make small triangles' clusters as fine. Where they are not, elements were not given.
  if (settings.at("cluster_factor").get<double>() == 1) add(words, "--elements", text(settings.at("elements")));
  constexpr std::array<std::array<const char*, 2>, 11> kOptions{{{"samples", "--samples"},
                                                                 {"filter", "--filter"},
                                                                 {"refine", "--refine"},
                                                                 {"hemicube", "--hemicube"},
                                                                 {"shot_points", "--shot-points"},
                                                                 {"emission_records", "--emission-records"},
                                                                 {"max_shots", "--max-shots"},
                                                                 {"bounces", "--bounces"},
                                                                 {"direct", "--direct"},
                                                                 {"texels", "--texels"},
                                                                 {"seed", "--seed"}}};
  for (const auto& [key, option] : kOptions) add(words, option, text(settings.at(key)));
  if (settings.at("unshot").get<double>() >= kLeastUnshotOption) add(words, "--unshot", text(settings.at("unshot")));
  if (settings.at("two_sided_lights").get<bool>()) words.emplace_back("--two-sided-lights");
}

bool automatic(const Json& settings, const char* key) {
  const auto& names = settings.at("automatic");
  return std::find(names.begin(), names.end(), Json(key)) != names.end();
}

const Json& at_path(const Json& table, std::string_view key) {
  const std::size_t dot = key.find('.');
  const Json& value = table.at(std::string(key.substr(0, dot)));
  return dot == std::string_view::npos ? value : at_path(value, key.substr(dot + 1));
}

MachineValue machine_value(const Json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_float()) return value.get<double>();
  return value.get<std::uint64_t>();
}

/// Parameters that are not as built in.
void add_machine(Words& words, const Json& machine) {
  for (const MachineSetting& built_in : machine_description_values({})) {
    const std::string value = text_of(machine_value(at_path(machine, built_in.key)));
    if (value != text_of(built_in.value)) add(words, "--set", built_in.key + "=" + value);
  }
}

void add_engine(Words& words, const Json& settings) {
  if (settings.at("engine") != kDefaultEngine) add(words, "--engine", text(settings.at("engine")));
  if (const auto pes = settings.find("qemu_pes"); pes != settings.end()) add(words, "--qemu-pes", joined(*pes, ','));
}

Words render_words(const Json& settings) {
  Words words = {"render", text(settings.at("scene_path"))};
  if (settings.at("studio").get<bool>()) words.emplace_back("--studio");
  if (settings.contains("missing_materials")) add(words, "--missing-materials", text(settings.at("missing_materials")));
  for (const Json& input : settings.at("inputs")) {
    if (input.at("role") == "radiosity") add(words, "--radiosity", text(input.at("path")));
  }
  add_camera(words, settings.at("camera"));
  add(words, "--exposure", text(settings.at("exposure")));
  add(words, "--tone-curve", text(settings.at("tone_curve")));
  add_quality(words, settings);
  add(words, "--pes", joined(settings.at("pes"), 'x'));
  if (!automatic(settings, "pe_memory")) add(words, "--pe-memory", text(settings.at("pe_memory")));
  add(words, "--subspaces", automatic(settings, "subspaces") ? "auto" : joined(settings.at("subspaces"), 'x'));
  add(words, "--scheme", text(settings.at("scheme")));
  add(words, "--allocation", text(settings.at("allocation")));
  add(words, "--replicate", text(settings.at("replicate")));
  add(words, "--points", text(settings.at("points")));
  add(words, "--empty", text(settings.at("empty")));
  add(words, "--camera-rays", text(settings.at("camera_rays")));
  if (!settings.at("skip_empty_subspaces").get<bool>()) words.emplace_back("--enter-empty");
  return words;
}

}  // namespace

Words command_line_of(const Json& settings) {
  try {
    Words words;
    if (settings.at("command") == "render") {
      words = render_words(settings);
    } else if (settings.at("command") == "run") {
      words = {"run",         text(settings.at("image")),    "--pes", joined(settings.at("pes"), 'x'),
               "--pe-memory", text(settings.at("pe_memory"))};
    } else {
      throw InputError("these are settings of the command '" + text(settings.at("command")) +
                       "'; only render and run are repeated");
    }
    add_engine(words, settings);
    add_machine(words, settings.at("machine"));
    return words;
  } catch (const Json::exception& error) {
    throw InputError(std::string("the settings are not whole: ") + error.what());
  }
}

}  // namespace torolux
