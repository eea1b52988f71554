// SPDX-License-Identifier: MIT
// The figures of a run enter, a text for people leaves.
#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "emulator/machine/network_memory.hpp"
#include "host_tools/report/figures.hpp"
#include "host_tools/report/limits.hpp"
#include "host_tools/report/text.hpp"

namespace torolux {
namespace {

constexpr std::size_t kLabel = 22;
constexpr std::size_t kColumn = 17;

/// One line of a table: a label and right-aligned columns.
std::string row(const std::string& label, const std::vector<std::string>& columns) {
  std::string text = left(label, kLabel);
  for (const std::string& column : columns) text += right(column, kColumn);
  return text + "\n";
}

struct Spread {
  double least = 0, mean = 0, most = 0;
};

template <class Value>
Spread spread_of(const std::vector<PeFigures>& pes, Value value) {
  if (pes.empty()) return {};
  Spread result{value(pes.front()), 0, value(pes.front())};
  for (const PeFigures& pe : pes) {
    const double v = value(pe);
    result.least = std::min(result.least, v);
    result.most = std::max(result.most, v);
    result.mean += v / static_cast<double>(pes.size());
  }
  return result;
}

std::string stages_table(const RunDescription& run, const RenderFigures& figures) {
  const double hertz = run.machine.description.processor.clock_hertz;
  const auto line = [&](const char* label, Cycles cycles) {
    return row(label, {grouped(cycles), fixed(1e3 * static_cast<double>(cycles) / hertz, 3)});
  };
  const Cycles total =
      figures.draft_cycles + figures.load_cycles + figures.radiosity_cycles + figures.ray_tracing_cycles;
  const std::string draft = figures.draft_cycles > 0 ? line("  draft", figures.draft_cycles) : "";
  return row("virtual time", {"cycles", "ms"}) + draft + line("  load", figures.load_cycles) +
         line("  radiosity", figures.radiosity_cycles) + line("  ray tracing", figures.ray_tracing_cycles) +
         line("  total", total);
}

std::string load_table(const MachineFigures& machine) {
  const auto line = [&](const char* label, const Spread& s, auto text) {
    return row(label, {text(s.least), text(s.mean), text(s.most)});
  };
  const auto count = [](double v) { return grouped(static_cast<std::uint64_t>(std::llround(v))); };
  const auto& pes = machine.pes;
  return row("load of the " + std::to_string(pes.size()) + " PEs", {"min", "mean", "max"}) +
         line("  busy", spread_of(pes, busy_share), [](double v) { return percent(v); }) +
         line("  instructions",
              spread_of(pes, [](const PeFigures& pe) { return static_cast<double>(pe.instructions); }), count) +
         line("  record slots used",
              spread_of(pes, [](const PeFigures& pe) { return static_cast<double>(pe.record_slots_high_water); }),
              count);
}

/// One line for each stage: its length, what the PEs did in it, and what bounds it.
std::string limits_table(const RenderFigures& figures) {
  constexpr std::size_t kShare = 10;
  const auto line = [](const std::string& label, const std::array<std::string, 3>& shares, const std::string& by) {
    std::string text = left(label, kLabel - kShare / 2);
    for (const std::string& share : shares) text += right(share, kShare);
    return text + "   " + by + "\n";
  };
  std::string text;
  for (const StageFigures& stage : figures.machine.stages) {
    const Limits limits = limits_of(stage, figures.rounds);
    std::string name = stage.name;
    std::replace(name.begin(), name.end(), '_', ' ');
    const auto share = [&](Limit limit) { return percent(limits.shares[static_cast<std::size_t>(limit)], 0); };
    text += line("  " + name, {share(Limit::work), share(Limit::balance), share(Limit::waiting)}, limit_text(limits));
  }
  return text.empty() ? text : line("stages", {"PEs busy", "unequally", "all wait"}, "bounded by") + text;
}

std::string traffic(const RenderFigures& figures) {
  std::uint64_t sent = 0;
  std::uint64_t delivered = 0;
  std::uint64_t diverted = 0;
  for (const PeFigures& pe : figures.machine.pes) {
    sent += pe.packets_sent;
    delivered += pe.packets_delivered;
    diverted += pe.records_diverted;
  }
  const double hops =
      delivered > 0 ? static_cast<double>(figures.machine.packets.hops) / static_cast<double>(delivered) : 0;
  return left("packets", kLabel) + "  " + grouped(sent) + " sent, " + grouped(delivered) + " delivered, " +
         fixed(hops, 2) + " hops on average\n" + left("records", kLabel) + "  " + grouped(figures.radiosity_records) +
         " from " + grouped(figures.shots) + " shots, " + grouped(figures.rays) + " rays; " + grouped(diverted) +
         " diverted\n" + left("credits", kLabel) + "  " + grouped(figures.credits_home) + " of " +
         grouped(figures.credits_total) + " home\n";
}

std::string energy_table(const EnergyBalance& energy) {
  const double emitted = energy.emitted[0] + energy.emitted[1] + energy.emitted[2];
  if (!(emitted > 0)) return left("energy", kLabel) + "  no radiosity stage\n";
  const auto line = [&](const char* label, const std::array<double, 3>& v) {
    std::string text = left(label, kLabel);
    for (const double channel : v) text += right(significant(channel, 6), 14);
    return text + right(percent((v[0] + v[1] + v[2]) / emitted, 2), 14) + "\n";
  };
  std::string head = left("energy [W]", kLabel);
  for (const char* column : {"R", "G", "B", "share"}) head += right(column, 14);
  return head + "\n" + line("  emitted", energy.emitted) + line("  absorbed, diffuse", energy.absorbed) +
         line("  absorbed, specular", energy.absorbed_specular) + line("  unshot", energy.unshot) +
         line("  escaped", energy.escaped) + line("  cut off", energy.cut_off) +
         line("  on back sides", energy.back_side) + left("  closing error", kLabel) +
         right(significant(closing_error(energy), 2), 14) + "\n";
}

/// Subspaces that stand on every PE in the radiosity and in the ray tracing stage.
std::string copies_text(const RunDescription& run, const RenderFigures& figures) {
  if (run.machine.replicate == 0.0) return "";
  const StageCopies& radiosity = figures.radiosity_copies;
  const StageCopies& rays = figures.ray_tracing_copies;
  return left("on every PE", kLabel) + "  " + grouped(radiosity.cells) + " and " + grouped(rays.cells) + " of " +
         grouped(figures.filled_subspaces) + " subspaces, " + percent(copies_share(radiosity, figures), 0) + " and " +
         percent(copies_share(rays, figures), 0) + " of memory\n" +
         (rays.kept > 0 ? left("on one PE alone", kLabel) + "  the light of " + grouped(rays.kept) + " surfaces\n"
                        : "");
}

}  // namespace

double closing_error(const EnergyBalance& energy) {
  double worst = 0;
  for (std::size_t c = 0; c < 3; ++c) {
    if (!(energy.emitted[c] > 0)) continue;
    const double found = energy.absorbed[c] + energy.absorbed_specular[c] + energy.unshot[c] + energy.escaped[c] +
                         energy.cut_off[c] + energy.back_side[c];
    worst = std::max(worst, std::fabs(energy.emitted[c] - found) / energy.emitted[c]);
  }
  return worst;
}

double copies_share(const StageCopies& copies, const RenderFigures& figures) {
  const std::uint32_t memory = figures.local_memory_bytes;
  return memory > 0 ? static_cast<double>(copies.bytes) / memory : 0;
}

double busy_share(const PeFigures& pe) {
  const Cycles all = pe.busy_cycles + pe.idle_cycles();
  return all > 0 ? static_cast<double>(pe.busy_cycles) / static_cast<double>(all) : 0;
}

std::string summary(const RunDescription& run, const RenderFigures& figures) {
  std::string text;
  for (const auto& picture : run.pictures)
    text += left("picture", kLabel) + "  " + picture.string() + " (" + std::to_string(run.quality.width) + " x " +
            std::to_string(run.quality.height) + ")\n";
  const auto& cells = figures.subspaces;
  text += left("machine", kLabel) + "  " + std::to_string(run.machine.columns) + " x " +
          std::to_string(run.machine.rows) + " PEs of " + bytes_text(figures.local_memory_bytes) + " on " +
          run.machine.engine + "\n" + left("subspaces", kLabel) + "  " + std::to_string(cells[0]) + " x " +
          std::to_string(cells[1]) + " x " + std::to_string(cells[2]) + ", " + run.machine.allocation + "\n";
  text += copies_text(run, figures);
  const NetworkMemory network = network_memory(run.machine.description);
  text += left("network memory", kLabel) + "  NIU " + bytes_text(network.niu()) + ", router " +
          bytes_text(network.router()) + " of each PE\n";
  text += stages_table(run, figures) + load_table(figures.machine) + limits_table(figures) + traffic(figures) +
          energy_table(figures.energy);
  return text + left("wall time", kLabel) + "  " + duration(figures.wall_seconds) + "\n";
}

}  // namespace torolux
