// SPDX-License-Identifier: MIT
// A machine with the host program of `torolux run`, run to its end; its figures as JSON.
#include "host_tools/run/run.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "emulator/errors.hpp"
#include "host_tools/report/machine_json.hpp"
#include "host_tools/report/settings_json.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/report/version.hpp"

namespace torolux {
namespace {

/// They may wait for a PE that has given up.
std::string after_exit(const std::optional<PeExit>& exit) {
  if (!exit) return "";
  return "; PE " + std::to_string(exit->pe) + " had ended with exit status " + std::to_string(exit->status) +
         " at cycle " + std::to_string(exit->time);
}

/// The machine stops when nothing can happen any more. That is the end only if every program has ended: else what is
/// wrong leaves.
std::string hang_of(const Machine& machine, const RunOutcome& outcome) {
  const MachineFigures& figures = outcome.figures;
  constexpr std::size_t kMostNamed = 16;
  std::string waiting;
  std::size_t count = 0;
  for (std::size_t pe = 0; pe < figures.pes.size(); ++pe) {
    if (figures.pes[pe].halted) {
      continue;
    }
    if (count++ < kMostNamed) {
      waiting += (waiting.empty() ? "" : ", ") + std::to_string(pe);
    }
  }
  if (figures.stopped || count == 0) return "";
  return "at cycle " + std::to_string(figures.now) + " nothing is under way any more, and " + std::to_string(count) +
         (count == 1 ? " PE still waits to receive: PE " : " PEs still wait to receive: PE ") + waiting +
         (count > kMostNamed ? ", ..." : "") + after_exit(outcome.first_exit) + machine.where_pes_stand();
}

/// What is wrong with what is kept of a run that has failed is told behind the failure.
[[noreturn]] void end_failed(const Machine& machine, const std::string& failure, const AtEnd& at_end) {
  try {
    if (at_end) at_end(machine);
  } catch (const InputError& error) {
    throw MachineFailure(failure + "\n" + error.what());
  }
  throw MachineFailure(failure);
}

}  // namespace

RunOutcome run_program(const MachineSetup& setup, ImageSet images, ServedFiles& files,
                       const std::function<void(const PeText&)>& on_text,
                       const std::function<bool(const Machine&, Cycles)>& progress, const AtEnd& at_end,
                       SnapshotReader* from) {
  Machine machine(setup, std::move(images));
  Listener listener(files, on_text);
  if (from != nullptr) listener.restore(*from);
  std::string hang;
  try {
    machine.run(
        listener, [&](Cycles now) { return !progress || progress(machine, now); }, Machine::Then::stay, from);
    hang = hang_of(machine, {machine.figures(), listener.first_exit()});
    machine.end();
  } catch (const MachineFailure& failure) {
    listener.finish();
    end_failed(machine, failure.what(), at_end);
  }
  listener.finish();
  if (!hang.empty()) end_failed(machine, hang, at_end);
  if (at_end) at_end(machine);
  return {machine.figures(), listener.first_exit()};
}

MachineFigures run_image(const MachineSetup& setup, ImageSet images, const std::function<void(const PeText&)>& on_text,
                         const std::function<bool(const Machine&, Cycles)>& progress, const AtEnd& at_end) {
  ServedFiles none({}, {});
  return run_program(setup, std::move(images), none, on_text, progress, at_end).figures;
}

std::string run_stats_json(const MachineSetup& setup, const ProgramFiles& inputs, const MachineFigures& figures,
                           double wall_seconds) {
  using Json = nlohmann::ordered_json;
  Json json;
  json["version"] = kVersion;
  json["engine"] = setup.engine;
  json["virtual_cycles"] = {{"total", figures.now}};
  json.update(machine_json(figures));
  json["trace_hash"] = hexadecimal(figures.trace_hash);
  json["settings"] = settings_json(setup, inputs);
  json["command_line"] = command_line_of(json["settings"]);
  json["stages"] = stages_json(figures, {});
  json["time_line"] = time_line_json(figures.time_line);
  json["links"] = links_json(figures);
  json["pes"] = pes_json(figures.pes, figures.phases);
  json["wall_seconds"] = wall_seconds;
  json["host"] = {{"threads", setup.threads},
                  {"scheduler_seconds", figures.scheduler_seconds},
                  {"program_seconds", figures.program_seconds},
                  {"engine_seconds", figures.engine_seconds}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace torolux
