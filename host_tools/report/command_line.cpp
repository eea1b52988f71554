// SPDX-License-Identifier: MIT
// The block `settings` of a run's statistics enters, the command line that leads to it again leaves.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/settings/options.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;
using Words = std::vector<std::string>;

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
  constexpr std::array<std::array<const char*, 2>, 6> kOptions{{{"eye", "--eye"},
                                                                {"look_at", "--look-at"},
                                                                {"up", "--up"},
                                                                {"field_of_view", "--fov"},
                                                                {"aperture", "--aperture"},
                                                                {"focus", "--focus"}}};
  for (const auto& [key, option] : kOptions) {
    if (const auto given = camera.find("given"); given != camera.end()) {
      if (std::find(given->begin(), given->end(), Json(key)) == given->end()) continue;
    }
    const bool of_lens = option == std::string_view("--aperture") || option == std::string_view("--focus");
    if (of_lens && !camera.contains(key)) continue;
    const Json& value = camera.at(key);
    add(words, option, value.is_array() ? joined(value, ',') : text(value));
  }
}

/// What the command line does not take is the scene's own, and the preset's.
bool is_taken(const Option& option, const Json& value) {
  const auto* number = std::get_if<option::Number>(&option.kind);
  if (number == nullptr || !number->least_on_command_line) return true;
  return value.get<double>() >= *number->least_on_command_line;
}

void add_option(Words& words, const Option& option, const Json& settings) {
  const Json& value = settings.at(option.key);
  if (const auto* flag = std::get_if<option::Flag>(&option.kind)) {
    if (value.get<bool>() == flag->given) words.push_back(option.name);
  } else if (std::holds_alternative<option::Layers>(option.kind)) {
    if (!value.empty()) add(words, option.name, joined(value, ','));
  } else if (is_taken(option, value)) {
    add(words, option.name, text(value));
  }
}

/// The options of the table among which the option is; in the statistics for which there is an option.
template <class Among>
void add_options(Words& words, const Json& settings, Among among) {
  for (const Option& option : all_options()) {
    if (!option.name.empty() && !option.key.empty() && among(option)) add_option(words, option, settings);
  }
}

/// Where a picture's option stands on the command line: these first, and these last, as before there was a table.
constexpr int kLastPlace = 4;
int place_of(const Option& option) {
  const auto one_of = [&option](std::initializer_list<std::string_view> names) {
    return std::find(names.begin(), names.end(), option.name) != names.end();
  };
  if (one_of({"--exposure", "--tone-curve", "--white-balance"})) return 0;
  if (one_of({"--layers", "--patches", "--elements"})) return 1;
  if (one_of({"--texels", "--seed"})) return 3;
  if (one_of({"--unshot", "--two-sided-lights"})) return kLastPlace;
  return 2;
}

void add_picture(Words& words, const Json& settings) {
  // Elements that are given make small triangles' clusters as fine. Where they are not, elements were not given.
  const bool elements_given = settings.at("cluster_factor").get<double>() == 1;
  for (int place = 0; place <= kLastPlace; ++place) {
    add_options(words, settings, [&](const Option& option) {
      if (option.name == "--elements" && !elements_given) return false;
      return option.bears_on != BearsOn::machine && place_of(option) == place;
    });
    if (place > 0) continue;
    add(words, "--quality", text(settings.at("quality")));
    add(words, "--size", text(settings.at("width")) + "x" + text(settings.at("height")));
  }
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
  const char* const usual = settings.at("command") == "run" ? kAutomaticEngine : kDefaultEngine;
  if (settings.at("engine") != usual) add(words, "--engine", text(settings.at("engine")));
  if (const auto pes = settings.find("qemu_pes"); pes != settings.end()) add(words, "--qemu-pes", joined(*pes, ','));
}

Words render_words(const Json& settings) {
  Words words = {"render", text(settings.at("scene_path"))};
  if (settings.at("studio").get<bool>()) words.emplace_back("--studio");
  if (settings.contains("missing_materials")) add(words, "--missing-materials", text(settings.at("missing_materials")));
  if (settings.contains("gltf_units")) add(words, "--gltf-units", text(settings.at("gltf_units")));
  if (settings.contains("camera_name")) add(words, "--camera", text(settings.at("camera_name")));
  bool has_path = false;
  for (const Json& input : settings.at("inputs")) {
    if (input.at("role") == "radiosity") add(words, "--radiosity", text(input.at("path")));
    if (input.at("role") != "path") continue;
    has_path = true;
    add(words, "--path", text(input.at("path")));
  }
  if (!has_path) add_camera(words, settings.at("camera"));
  add_picture(words, settings);
  add(words, "--pes", joined(settings.at("pes"), 'x'));
  if (!automatic(settings, "pe_memory")) add(words, "--pe-memory", text(settings.at("pe_memory")));
  add(words, "--subspaces", automatic(settings, "subspaces") ? "auto" : joined(settings.at("subspaces"), 'x'));
  add_options(words, settings, [](const Option& option) { return option.bears_on == BearsOn::machine; });
  return words;
}

/// One image of all PEs, or each one's PEs.
Words run_words(const Json& settings) {
  Words words = {"run"};
  if (const auto images = settings.find("images"); images != settings.end()) {
    for (const Json& image : *images) {
      const Json& input = settings.at("inputs").at(image.at("input").get<std::size_t>());
      add(words, "--image", text(image.at("pes")) + "=" + text(input.at("path")));
    }
  } else {
    words.push_back(text(settings.at("image")));
  }
  add(words, "--pes", joined(settings.at("pes"), 'x'));
  add(words, "--pe-memory", text(settings.at("pe_memory")));
  if (const auto until = settings.find("until"); until != settings.end()) add(words, "--until", text(*until));
  return words;
}

/// What the program reads, and may write: to nowhere, as results are not repeated. Arguments come last.
void add_program(Words& words, const Json& settings) {
  constexpr std::string_view kInput = "input ";
  for (const Json& input : settings.at("inputs")) {
    const std::string role = text(input.at("role"));
    if (role.starts_with(kInput)) add(words, "--input", role.substr(kInput.size()) + "=" + text(input.at("path")));
  }
  for (const Json& output : settings.value("outputs", Json::array()))
    add(words, "--output", text(output) + "=/dev/null");
  const Json arguments = settings.value("arguments", Json::array());
  if (!arguments.empty()) words.emplace_back("--");
  for (const Json& argument : arguments) words.push_back(text(argument));
}

}  // namespace

Words command_line_of(const Json& settings) {
  try {
    Words words;
    if (settings.at("command") == "render") {
      words = render_words(settings);
    } else if (settings.at("command") == "run") {
      words = run_words(settings);
    } else {
      throw InputError("these are settings of the command '" + text(settings.at("command")) +
                       "'; only render and run are repeated");
    }
    add_engine(words, settings);
    add_machine(words, settings.at("machine"));
    if (settings.at("command") == "run") add_program(words, settings);
    return words;
  } catch (const Json::exception& error) {
    throw InputError(std::string("the settings are not whole: ") + error.what());
  }
}

}  // namespace torolux
