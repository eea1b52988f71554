// SPDX-License-Identifier: MIT
// What the fuzzers of a study's plan and of statistics to be repeated do with their bytes: load, use what was loaded,
// let only refusals pass.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "emulator/errors.hpp"
#include "host_tools/cli/prepared_render.hpp"
#include "host_tools/cli/run_options.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/study/points.hpp"

namespace torolux {

/// True: loaded. False: refused as bad input, with a message that names the file. Anything else ends the program.
inline bool load_study_plan(const std::string& text) {
  try {
    const study::Plan plan = study::parse_plan(text, "fuzzed.toml");
    if (study::points_of(plan).empty()) __builtin_trap();
    return true;
  } catch (const InputError& error) {
    if (!std::string(error.what()).starts_with("fuzzed.toml")) __builtin_trap();
    return false;
  }
}

/// True: a command line has been made of the settings, and read. What `rerun` catches is a refusal.
inline bool load_statistics(const std::string& text) {
  const auto json = nlohmann::ordered_json::parse(text, nullptr, false);
  if (json.is_discarded() || !json.is_object() || !json.contains("settings")) return false;
  try {
    std::vector<std::string> words = command_line_of(json["settings"]);
    if (words.empty()) __builtin_trap();
    const std::string command = words.front();
    words.erase(words.begin());
    if (command == "render") {
      parse_render_options(words);
    } else {
      parse_run_options(words);
    }
    return true;
  } catch (const UsageError&) {
    return false;
  } catch (const InputError&) {
    return false;
  } catch (const nlohmann::json::exception&) {
    return false;
  }
}

}  // namespace torolux
