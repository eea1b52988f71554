// SPDX-License-Identifier: MIT
// Names are looked for in the statistics of a run of nothing, which have all keys but those that depend on the run.
#include "host_tools/study/report_names.hpp"

#include <algorithm>
#include <array>

#include "emulator/nearest_name.hpp"
#include "host_tools/network/network_columns.hpp"
#include "host_tools/report/figures.hpp"
#include "host_tools/run/run.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/study/figures.hpp"
#include "host_tools/study/points.hpp"

namespace torolux::study {
namespace {

/// What is in them depends on the run.
constexpr std::array<std::string_view, 8> kOpen = {"kinds",   "phases", "phase_cycles",  "settings",
                                                   "picture", "path",   "layers_sha256", "draft"};

bool is_open(std::string_view key) {
  return std::ranges::find(kOpen, key) != kOpen.end();
}

MachineFigures figures_of_nothing() {
  MachineFigures machine;
  machine.pes.resize(1);
  machine.routers.resize(1);
  machine.stages.resize(1);
  machine.stages[0].figures.pes.resize(1);
  machine.time_line.slices.resize(1);
  return machine;
}

/// Of one PE, one stage, one round.
Json model_of(const std::string& command) {
  if (command == "run")
    return Json::parse(run_stats_json({}, {InputFile{"image", "an image", ""}, {}, {}}, figures_of_nothing(), 0));
  RenderFigures figures;
  figures.machine = figures_of_nothing();
  figures.rounds.resize(1);
  return Json::parse(stats_json({}, figures));
}

/// An array stands for one of any length, its first element for all.
bool may_have(const Json& model, std::string_view name) {
  const Json* at = &model;
  while (!name.empty()) {
    const std::size_t dot = name.find('.');
    const std::string part(name.substr(0, dot));
    name = dot == std::string_view::npos ? std::string_view() : name.substr(dot + 1);
    if (is_open(part)) return true;
    if (at->is_array()) {
      if (part.empty() || part.find_first_not_of("0123456789") != std::string::npos) return false;
      if (at->empty()) return true;
      at = &at->front();
    } else {
      if (!at->is_object() || !at->contains(part)) return at->is_null();
      at = &at->at(part);
    }
  }
  return true;
}

std::vector<std::string> keys_of(const Json& model) {
  std::vector<std::string> keys;
  const Json flat = model.flatten();
  for (const auto& [pointer, value] : flat.items()) {
    if (pointer.empty()) continue;  // of an object without keys
    std::string name = pointer.substr(1);
    std::ranges::replace(name, '/', '.');
    keys.push_back(name);
  }
  return keys;
}

}  // namespace

void check_report_names(const Plan& plan) {
  const bool network = plan.command == "network";
  const Json model = network ? Json::object() : model_of(plan.command);
  std::vector<std::string> known = varied_names(plan);
  if (!plan.vary_one.empty()) known.insert(known.end(), {"varied", "value"});
  std::ranges::copy(network ? network_columns() : derived_names(), std::back_inserter(known));
  std::vector<std::string> names = plan.report.y;
  names.insert(names.end(), {plan.report.x, plan.report.by});
  for (const std::string& name : names) {
    if (name.empty() || std::ranges::find(known, name) != known.end() || (!network && may_have(model, name))) continue;
    std::ranges::copy(keys_of(model), std::back_inserter(known));
    const std::string near = nearest_name(name, known);
    refuse({plan.file.string(), plan.report.lines.at(name)},
           "[report]: no run has a figure " + in_quotes(name) +
               (near.empty() ? "; docs/studies.md lists figures, docs/statistics.md all keys"
                             : "; did you mean '" + near + "'?"));
  }
}

}  // namespace torolux::study
