// SPDX-License-Identifier: MIT
// The options of `torolux run`, and the machine that they ask for.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "emulator/machine/machine.hpp"
#include "host_tools/cli/display_options.hpp"
#include "host_tools/cli/ending_options.hpp"
#include "host_tools/cli/fault_options.hpp"
#include "host_tools/cli/image_options.hpp"
#include "host_tools/cli/prepared_render.hpp"
#include "host_tools/cli/program_options.hpp"
#include "host_tools/cli/rank_options.hpp"
#include "host_tools/cli/trace_options.hpp"
#include "host_tools/report/settings_json.hpp"

namespace CLI {
class App;
}

namespace torolux {

struct RunOptions {
  ImageOptions images;
  EndingOptions ending;
  std::string pes = "4x4";
  std::string pe_memory = "1M";
  std::string engine = kAutomaticEngine;
  std::optional<std::string> machine, stats, stats_csv, report;
  std::vector<std::string> machine_values;  ///< KEY=VALUE, checked, in the order given
  Debugging debugging;
  RankOptions ranks;
  FaultOptions faults;
  MachineDescription::Ideal ideal;
  unsigned threads = 0;
  ProgramOptions program;
  TraceOptions trace;
  DisplayOptions display;
  bool quiet = false;
  profile::CycleProfile* profile = nullptr;  ///< to be filled in (`torolux profile`); null: none
  std::function<std::string()>
      profile_for_report;  ///< called when it is, for the report (ReportInput); none: no profile
};

void add_run_options(CLI::App& command, RunOptions& options);

/// words: what stands after `torolux run`. Throws UsageError, InputError.
RunOptions parse_run_options(const std::vector<std::string>& words);

/// What a run's statistics tell of its files; setup: as setup_from; read: its inputs. Throws as images_of.
ProgramFiles program_files(const RunOptions& options, const MachineSetup& setup, const std::vector<Input>& read);

/// Runs the image; writes and prints what the options ask for. Throws UsageError, InputError, MachineFailure.
/// ranks: run the PEs; null: this process does.
RunEnd run_prepared(const RunOptions& options, remote::PeRanks* ranks = nullptr);

/// Reads the machine file, if one was named. Throws UsageError, InputError.
MachineSetup setup_from(const RunOptions& options);

}  // namespace torolux
