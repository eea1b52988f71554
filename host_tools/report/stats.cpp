// SPDX-License-Identifier: MIT
// The figures of a run enter, a JSON object for programs leaves.
#include <nlohmann/json.hpp>

#include "host_tools/report/figures.hpp"
#include "host_tools/report/machine_json.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/report/version.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

Json energy_json(const EnergyBalance& energy) {
  return {{"emitted", energy.emitted},
          {"absorbed", energy.absorbed},
          {"absorbed_specular", energy.absorbed_specular},
          {"unshot", energy.unshot},
          {"escaped", energy.escaped},
          {"cut_off", energy.cut_off},
          {"back_side", energy.back_side},
          {"closing_error", closing_error(energy)}};
}

/// Subspaces on every PE in a stage.
Json copies_json(const StageCopies& copies, const RenderFigures& figures) {
  return {{"subspaces", copies.cells},
          {"bytes", copies.bytes},
          {"fraction", copies_share(copies, figures)},
          {"kept_surfaces", copies.kept}};
}

Json picture_json(const RunDescription& run, const RenderFigures& figures) {
  Json json = {{"sha256", figures.picture_sha256}};
  const std::vector<LayerName> layers = layers_in(run.quality.layers);
  for (std::size_t i = 0; i < layers.size() && i < figures.layers_sha256.size(); ++i)
    json["layers_sha256"][std::string(layers[i].name)] = figures.layers_sha256[i];
  return json;
}

}  // namespace

std::string stats_json(const RunDescription& run, const RenderFigures& figures) {
  const MachineFigures& machine = figures.machine;
  Json json;
  json["version"] = kVersion;
  json["engine"] = run.machine.engine;
  json["virtual_cycles"] = {{"load", figures.load_cycles},
                            {"radiosity", figures.radiosity_cycles},
                            {"ray_tracing", figures.ray_tracing_cycles},
                            {"total", machine.now}};
  json.update(machine_json(machine));
  if (figures.draft_cycles > 0) {
    json["draft"] = {
        {"virtual_cycles", figures.draft_cycles}, {"records", figures.draft_records}, {"splits", figures.splits}};
  }
  json["records"]["created"] = figures.radiosity_records + figures.rays;
  json["credits"] = {{"total", figures.credits_total}, {"home", figures.credits_home}};
  json["energy"] = energy_json(figures.energy);
  json["copies"] = {{"of_subspaces", figures.filled_subspaces},
                    {"radiosity", copies_json(figures.radiosity_copies, figures)},
                    {"ray_tracing", copies_json(figures.ray_tracing_copies, figures)}};
  json["memory"] = {{"needed", figures.memory_needed}, {"mean_needed", figures.mean_memory_needed}};
  json["shots"] = figures.shots;
  json["rays"] = figures.rays;
  json["picture"] = picture_json(run, figures);
  for (const PathFrame& frame : figures.path) {
    json["path"].push_back({{"virtual_cycles", frame.cycles}, {"sha256", frame.sha256}});
  }
  json["trace_hash"] = hexadecimal(machine.trace_hash);
  json["settings"] = settings_json(run, &figures);
  json["command_line"] = command_line_of(json["settings"]);
  json["stages"] = stages_json(machine, figures.rounds);
  json["time_line"] = time_line_json(machine.time_line);
  json["visits"] = {{"radiosity", figures.radiosity_visits}, {"ray_tracing", figures.ray_visits}};
  json["rounds"] = rounds_json(figures.rounds);
  json["links"] = links_json(machine);
  json["pes"] = pes_json(machine.pes, machine.phases);
  json["wall_seconds"] = figures.wall_seconds;
  json["host"] = {{"threads", run.machine.threads},
                  {"scheduler_seconds", machine.scheduler_seconds},
                  {"program_seconds", machine.program_seconds},
                  {"engine_seconds", machine.engine_seconds}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace torolux
