// SPDX-License-Identifier: MIT
// One function for each kind of figures. Keys that stand for reasons, phases and kinds come from the tables of names
// beside their enums.
#include "host_tools/report/machine_json.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "host_tools/report/limits.hpp"
#include "host_tools/report/sums.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

Json phases_of(const std::array<Cycles, protocol::kPhases>& cycles, Cycles outside, const PhaseNames& names) {
  Json phases = Json::object();
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (!names[i].empty()) phases[names[i]] = cycles[i];
  }
  phases["outside"] = outside;
  return phases;
}

Json waits_of(const WaitCycles& waits) {
  Json json = Json::object();
  for (std::size_t i = 0; i < kWaitReasons; ++i) json[std::string(kWaitReasonNames[i])] = waits[i];
  return json;
}

Json traffic_json(const BusTraffic& traffic) {
  return {{"transfers", traffic.transfers}, {"bytes", traffic.bytes}, {"cycles", traffic.cycles}};
}

Json bus_json(const MachineFigures& machine) {
  const BusFigures& bus = machine.bus;
  Json json = {{"busy_cycles", bus.busy_cycles()},
               {"idle_cycles", machine.now - bus.busy_cycles()},
               {"arbitration_cycles", bus.arbitration_cycles},
               {"messages", bus.transfers}};
  for (std::size_t i = 0; i < kBusUsers; ++i) {
    json["requesters"][std::string(kBusUserNames[i])] = traffic_json(bus.users[i]);
  }
  for (std::size_t i = 0; i < kBusKinds; ++i) json["kinds"][std::string(kBusKindNames[i])] = traffic_json(bus.kinds[i]);
  return json;
}

Json frame_buffer_json(const MachineFigures& machine) {
  return {{"busy_cycles", machine.frame_buffer_busy_cycles},
          {"idle_cycles", machine.now - machine.frame_buffer_busy_cycles},
          {"pixels_added", machine.pixels_added},
          {"message_cycles", machine.frame_buffer_message_cycles},
          {"queue_high_water", machine.frame_buffer_high_water}};
}

Json host_json(const MachineFigures& machine) {
  Json json = {{"busy_cycles", machine.host.busy_cycles}, {"idle_cycles", machine.now - machine.host.busy_cycles}};
  for (std::size_t i = 0; i < kHostWorks; ++i) {
    json["work"][std::string(kHostWorkNames[i])] = {{"items", machine.host.items[i]},
                                                    {"own_cycles", machine.host.own_cycles[i]}};
  }
  return json;
}

Json link_json(const LinkFigures& link, Cycles now) {
  return {{"packets", link.packets},
          {"flits", link.flits},
          {"wasted_flits", link.wasted_flits},
          {"busy_cycles", link.busy},
          {"idle_cycles", now - link.busy},
          {"stalled_cycles", link.stalled},
          {"queue_high_water", link.queue_high_water}};
}

/// The busiest of all; each of them is in links.csv, and under `links` of the whole run.
Json torus_json(const MachineFigures& machine) {
  Cycles busy = 0;
  Cycles most = 0;
  std::uint64_t flits = 0;
  std::uint64_t stalled = 0;
  for (const RouterFigures& router : machine.routers) {
    for (const LinkFigures& link : router.links) {
      busy += link.busy;
      most = std::max(most, link.busy);
      flits += link.flits;
      stalled += link.stalled;
    }
  }
  return {{"flits", flits}, {"link_busy_cycles", busy}, {"busiest_link_cycles", most}, {"stalled_cycles", stalled}};
}

Json histograms_json(const PacketFigures& packets) {
  Json json;
  json["packets_by_hops"] = packets.by_hops;
  json["bytes_by_hops"] = packets.bytes_by_hops;
  json["packets_by_records"] = packets.by_records;
  json["bytes_by_records"] = packets.bytes_by_records;
  std::size_t used = packets.by_latency.size();
  while (used > 0 && packets.by_latency[used - 1] == 0) --used;
  json["packets_by_latency"] =
      std::vector(packets.by_latency.begin(), packets.by_latency.begin() + static_cast<std::ptrdiff_t>(used));
  return json;
}

Json limits_json(const Limits& limits) {
  Json json = {{"by", kLimitNames[static_cast<std::size_t>(limits.by)]}, {"share", limits.share()}};
  for (std::size_t i = 0; i < kLimits; ++i) json["shares"][std::string(kLimitNames[i])] = limits.shares[i];
  return json;
}

}  // namespace

Json machine_json(const MachineFigures& machine) {
  const PeSums sums = sums_of(machine.pes);
  const double mean_hops =
      sums.delivered > 0 ? static_cast<double>(machine.packets.hops) / static_cast<double>(sums.delivered) : 0;
  Json json;
  const PacketFigures& packets = machine.packets;
  const double mean_latency =
      packets.packets > 0 ? static_cast<double>(packets.latency_sum) / static_cast<double>(packets.packets) : 0;
  json["packets"] = {{"sent", sums.sent},
                     {"delivered", sums.delivered},
                     {"link_retries", machine.link_retries},
                     {"mean_latency", mean_latency},
                     {"most_latency", packets.latency_most}};
  json["records"] = {{"diverted", sums.diverted}};
  for (const KindFigures& kind : machine.record_kinds) {
    json["kinds"][kind.name] = {{"packets", kind.packets}, {"records", kind.records}, {"bytes", kind.bytes}};
  }
  json["hops"] = {{"mean", mean_hops}, {"total", machine.packets.hops}, {"wasted", packets.wasted_hops}};
  json["torus"] = torus_json(machine);
  json["histograms"] = histograms_json(packets);
  json["bus"] = bus_json(machine);
  json["frame_buffer"] = frame_buffer_json(machine);
  json["host_processor"] = host_json(machine);
  json["busy_cycles"] = sums.busy;
  json["waits"] = waits_of(sums.waits);
  json["idle_at_end"] = sums.idle_at_end;
  json["phases"] = phases_of(sums.phases, sums.outside, machine.phases);
  return json;
}

Json pes_json(const std::vector<PeFigures>& pes, const PhaseNames& phases) {
  Json json = Json::array();
  for (const PeFigures& pe : pes) {
    json.push_back({{"begin", pe.begin},
                    {"cycles", pe.cycles},
                    {"busy_cycles", pe.busy_cycles},
                    {"idle_cycles", pe.idle_cycles()},
                    {"waits", waits_of(pe.waits)},
                    {"idle_at_end", pe.idle_at_end},
                    {"instructions", pe.instructions},
                    {"record_slots_high_water", pe.record_slots_high_water},
                    {"receive_buffers_high_water", pe.receive_buffers_high_water},
                    {"packets_sent", pe.packets_sent},
                    {"packets_delivered", pe.packets_delivered},
                    {"records_diverted", pe.records_diverted},
                    {"copy_out_cycles", pe.copy_out_cycles},
                    {"copy_in_cycles", pe.copy_in_cycles},
                    {"phase_cycles", phases_of(pe.phase_cycles, pe.outside_phases(), phases)}});
  }
  return json;
}

Json links_json(const MachineFigures& machine) {
  Json json = Json::array();
  for (const RouterFigures& router : machine.routers) {
    Json one;
    for (std::size_t i = 0; i < kLinks; ++i) one[std::string(kLinkNames[i])] = link_json(router.links[i], machine.now);
    one["injection"] = link_json(router.injection, machine.now);
    one["ejection"] = link_json(router.ejection, machine.now);
    json.push_back(std::move(one));
  }
  return json;
}

Json time_line_json(const TimeLineFigures& line) {
  Json slices = Json::array();
  for (const TimeSlice& slice : line.slices) {
    Json one = {{"load", slice.load},
                {"packets", slice.packets},
                {"bus_cycles", slice.bus_cycles},
                {"frame_buffer_cycles", slice.frame_buffer_cycles},
                {"host_cycles", slice.host_cycles}};
    for (std::size_t g = 0; g < kHostGauges; ++g) one[std::string(kHostGaugeNames[g])] = slice.gauges[g];
    slices.push_back(std::move(one));
  }
  return {{"slice_cycles", line.width}, {"slices", std::move(slices)}};
}

Json stages_json(const MachineFigures& machine, const std::vector<RoundFigures>& rounds) {
  Json json = Json::array();
  for (const StageFigures& stage : machine.stages) {
    Json one = {{"name", stage.name}, {"begin", stage.begin}, {"cycles", stage.figures.now}};
    one["limits"] = limits_json(limits_of(stage, rounds));
    one.update(machine_json(stage.figures));
    one["pes"] = pes_json(stage.figures.pes, machine.phases);
    json.push_back(std::move(one));
  }
  return json;
}

Json rounds_json(const std::vector<RoundFigures>& rounds) {
  Json json = Json::array();
  for (const RoundFigures& round : rounds) {
    json.push_back({{"begin", round.begin},
                    {"chosen", round.chosen},
                    {"last_shot_done", round.last_shot_done},
                    {"end", round.end},
                    {"tail", round.tail()},
                    {"shooters", round.shooters},
                    {"pes", round.pes},
                    {"records", round.records},
                    {"unshot", round.unshot}});
  }
  return json;
}

}  // namespace torolux
