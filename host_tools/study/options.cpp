// SPDX-License-Identifier: MIT
// The command line's own parser says which options there are; a plan's options enter, words leave.
#include "host_tools/study/options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <sstream>

#include "emulator/description/description.hpp"
#include "emulator/nearest_name.hpp"
#include "host_tools/cli/command.hpp"

namespace torolux::study {
namespace {

/// These a study decides itself, or they are for looking at one run.
constexpr std::array<std::string_view, 17> kNotInPlans = {
    "help",      "profile", "output",  "no-picture", "stats", "stats-csv", "quiet", "verbose", "save-radiosity",
    "save-mesh", "gdb",     "gdb-pes", "threads",    "set",   "format",    "ranks", "launcher"};
constexpr std::array<std::string_view, 3> kCommands = {"render", "run", "network"};
constexpr std::string_view kMachine = "machine.";

bool is_path(const std::string& name) {
  return name == "scene" || name == "image" || name == "radiosity" || name == "machine";
}

std::string lower(std::string text) {
  for (char& c : text)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return text;
}

Takes taken_by(const CLI::Option& option) {
  if (option.get_expected_max() == 0) return Takes::nothing;
  return option.get_expected_min() == 0 ? Takes::either : Takes::a_value;
}

}  // namespace

std::map<std::string, Takes> options_of(const std::string& command, const Place& place) {
  CLI::App app;
  CommandAction unused;
  add_commands(app, unused);
  const auto found = app.get_subcommands([&](const CLI::App* one) { return one->get_name() == command; });
  if (found.empty() || std::ranges::find(kCommands, command) == kCommands.end())
    refuse(place, no_such_name(command, "no command that is studied", {kCommands.begin(), kCommands.end()}));
  std::map<std::string, Takes> options;
  for (const CLI::Option* option : found.front()->get_options()) {
    if (option->get_positional()) options.emplace(lower(option->get_name()), Takes::a_value);
    for (const std::string& name : option->get_lnames()) {
      if (std::ranges::find(kNotInPlans, name) == kNotInPlans.end()) options.emplace(name, taken_by(*option));
    }
  }
  if (found.front()->get_option_no_throw("--set") != nullptr) {
    for (const std::string& key : machine_description_keys())
      options.emplace(std::string(kMachine) + key, Takes::either);
  }
  return options;
}

std::vector<std::string> words_of(const Plan& plan, std::span<const PlanOption> options) {
  std::vector<std::string> words = {plan.command};
  const auto value_of = [&](const PlanOption& option) {
    if (!is_path(option.name)) return option.value;
    return (plan.file.parent_path() / option.value).lexically_normal().string();
  };
  for (const PlanOption& option : options) {
    if (option.name == "scene" || option.name == "image") words.insert(words.begin() + 1, value_of(option));
  }
  for (const PlanOption& option : options) {
    if (option.name == "scene" || option.name == "image" || option.name == kArguments) continue;
    if (option.name.starts_with(kMachine)) {
      words.insert(words.end(), {"--set", option.name.substr(kMachine.size()) + "=" + option.value});
    } else if (!option.flag) {
      words.insert(words.end(), {"--" + option.name, value_of(option)});
    } else if (option.value == "true") {
      words.push_back("--" + option.name);
    }
  }
  for (const PlanOption& option : options) {
    if (option.name != kArguments) continue;
    words.push_back(kEndOfOptions);
    std::istringstream text(option.value);
    for (std::string word; text >> word;) words.push_back(word);
  }
  return words;
}

}  // namespace torolux::study
