// SPDX-License-Identifier: MIT
// A list of names with commas enters; a flag for each part leaves. Names that are no part are refused.
#include "host_tools/cli/ideal_option.hpp"

#include <CLI/CLI.hpp>
#include <array>
#include <sstream>
#include <string_view>
#include <utility>

#include "emulator/errors.hpp"

namespace torolux {
namespace {

using Ideal = MachineDescription::Ideal;
constexpr std::array<std::pair<std::string_view, bool Ideal::*>, 3> kParts = {
    {{"host", &Ideal::host}, {"niu", &Ideal::niu}, {"signals", &Ideal::signals}}};

}  // namespace

void make_ideal(const std::string& parts, Ideal& ideal) {
  std::istringstream list(parts + ",");
  for (std::string name; std::getline(list, name, ',');) {
    bool known = name == "all";
    for (const auto& [part, flag] : kParts) {
      if (name != part && name != "all") continue;
      ideal.*flag = true;
      known = true;
    }
    if (!known) {
      throw UsageError("--ideal: '" + name + "' is no part that can be ideal; allowed are host, niu, signals, with " +
                       "commas between them, or all");
    }
  }
}

void add_ideal_option(CLI::App& command, Ideal& ideal, const std::string& group) {
  CLI::Option* option = command.add_option_function<std::string>(
      "--ideal", [&ideal](const std::string& text) { make_ideal(text, ideal); },
      "Parts that cost nothing, to show what they cost otherwise: host, niu, signals, or all");
  option->type_name("PART[,PART...]")->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
  if (!group.empty()) option->group(group);
}

Ideal either(const Ideal& a, const Ideal& b) {
  Ideal both = a;
  for (const auto& [part, flag] : kParts) both.*flag = a.*flag || b.*flag;
  return both;
}

}  // namespace torolux
