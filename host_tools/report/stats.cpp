// SPDX-License-Identifier: MIT
// The figures of a run enter, a JSON object for programs leaves.
#include <nlohmann/json.hpp>

#include "firmware/protocol/hints.hpp"
#include "host_tools/report/figures.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/version.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

Json phases_of(const std::array<Cycles, protocol::kPhases>& cycles) {
  Json phases = Json::object();
  for (std::size_t i = 0; i < protocol::kPhaseNames.size(); ++i) phases[protocol::kPhaseNames[i]] = cycles[i];
  return phases;
}

Json pe_json(const PeFigures& pe) {
  return {{"busy_cycles", pe.busy_cycles},           {"idle_cycles", pe.idle_cycles()},
          {"instructions", pe.instructions},         {"record_slots_high_water", pe.record_slots_high_water},
          {"packets_sent", pe.packets_sent},         {"packets_delivered", pe.packets_delivered},
          {"records_diverted", pe.records_diverted}, {"phase_cycles", phases_of(pe.phase_cycles)}};
}

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

Json picture_json(const RunDescription& run, const RenderFigures& figures) {
  Json json = {{"sha256", figures.picture_sha256}};
  const std::vector<LayerName> layers = layers_in(run.quality.layers);
  for (std::size_t i = 0; i < layers.size() && i < figures.layers_sha256.size(); ++i)
    json["layers_sha256"][std::string(layers[i].name)] = figures.layers_sha256[i];
  return json;
}

struct Sums {
  std::uint64_t sent = 0, delivered = 0, diverted = 0;
  std::array<Cycles, protocol::kPhases> phases{};
};

Sums sums_of(const MachineFigures& machine) {
  Sums sums;
  for (const PeFigures& pe : machine.pes) {
    sums.sent += pe.packets_sent;
    sums.delivered += pe.packets_delivered;
    sums.diverted += pe.records_diverted;
    for (std::size_t i = 0; i < sums.phases.size(); ++i) sums.phases[i] += pe.phase_cycles[i];
  }
  return sums;
}

}  // namespace

std::string stats_json(const RunDescription& run, const RenderFigures& figures) {
  const MachineFigures& machine = figures.machine;
  const Sums sums = sums_of(machine);
  const double mean_hops =
      sums.delivered > 0 ? static_cast<double>(machine.hops) / static_cast<double>(sums.delivered) : 0;
  Json json;
  json["version"] = kVersion;
  json["engine"] = run.machine.engine;
  json["virtual_cycles"] = {{"load", figures.load_cycles},
                            {"radiosity", figures.radiosity_cycles},
                            {"ray_tracing", figures.ray_tracing_cycles}};
  json["packets"] = {{"sent", sums.sent}, {"delivered", sums.delivered}, {"link_retries", machine.link_retries}};
  if (figures.draft_cycles > 0) {
    json["draft"] = {
        {"virtual_cycles", figures.draft_cycles}, {"records", figures.draft_records}, {"splits", figures.splits}};
  }
  json["records"] = {{"created", figures.radiosity_records + figures.rays}, {"diverted", sums.diverted}};
  json["hops"] = {{"mean", mean_hops}, {"total", machine.hops}};
  json["credits"] = {{"total", figures.credits_total}, {"home", figures.credits_home}};
  json["energy"] = energy_json(figures.energy);
  json["shots"] = figures.shots;
  json["rays"] = figures.rays;
  json["bus"] = {{"busy_cycles", machine.bus.busy_cycles()}, {"messages", machine.bus.transfers}};
  json["frame_buffer"] = {{"busy_cycles", machine.frame_buffer_busy_cycles}, {"pixels_added", machine.pixels_added}};
  json["picture"] = picture_json(run, figures);
  json["trace_hash"] = hexadecimal(machine.trace_hash);
  json["phases"] = phases_of(sums.phases);
  json["settings"] = settings_json(run, &figures);
  json["command_line"] = command_line_of(json["settings"]);
  json["pes"] = Json::array();
  for (const PeFigures& pe : machine.pes) json["pes"].push_back(pe_json(pe));
  json["wall_seconds"] = figures.wall_seconds;
  json["host"] = {{"threads", run.machine.threads},
                  {"scheduler_seconds", machine.scheduler_seconds},
                  {"engine_seconds", machine.engine_seconds}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace torolux
