// SPDX-License-Identifier: MIT
// A machine with the host program of `torolux run`, run to its end; its figures as JSON.
#include "host_tools/run/run.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

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

/// The machine stops when nothing can happen any more. That is the end only if every program has ended.
void check_halted(const RunOutcome& outcome) {
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
  if (count != 0) {
    throw MachineFailure("at cycle " + std::to_string(figures.now) + " nothing is under way any more, and " +
                         std::to_string(count) + " PEs still wait to receive: PE " + waiting +
                         (count > kMostNamed ? ", ..." : "") + after_exit(outcome.first_exit));
  }
}

}  // namespace

RunOutcome run_program(const MachineSetup& setup, const Image& image, ServedFiles& files,
                       const std::function<void(const PeText&)>& on_text,
                       const std::function<bool(const Machine&, Cycles)>& progress) {
  Machine machine(setup, image);
  Listener listener(files, on_text);
  try {
    machine.run(listener, [&](Cycles now) { return !progress || progress(machine, now); });
  } catch (const MachineFailure&) {
    listener.finish();
    throw;
  }
  listener.finish();
  RunOutcome outcome{machine.figures(), listener.first_exit()};
  check_halted(outcome);
  return outcome;
}

MachineFigures run_image(const MachineSetup& setup, const Image& image,
                         const std::function<void(const PeText&)>& on_text,
                         const std::function<bool(const Machine&, Cycles)>& progress) {
  ServedFiles none({}, {});
  return run_program(setup, image, none, on_text, progress).figures;
}

std::string run_stats_json(const MachineSetup& setup, const ProgramFiles& inputs,
                           const MachineFigures& figures, double wall_seconds) {
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
  json["pes"] = pes_json(figures.pes);
  json["wall_seconds"] = wall_seconds;
  json["host"] = {{"threads", setup.threads},
                  {"scheduler_seconds", figures.scheduler_seconds},
                  {"engine_seconds", figures.engine_seconds}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace torolux
