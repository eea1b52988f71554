// SPDX-License-Identifier: MIT
// Words enter, options and a machine's set-up leave.
#include "host_tools/cli/run_options.hpp"

#include <CLI/CLI.hpp>

#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/debugging_options.hpp"
#include "host_tools/cli/ideal_option.hpp"
#include "host_tools/cli/named_value.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/parse_words.hpp"
#include "host_tools/cli/render_options.hpp"

namespace torolux {

void add_run_options(CLI::App& command, RunOptions& options) {
  add_image_options(command, options.images);
  add_program_options(command, options.program);
  command.add_option("--pes", options.pes, "PEs of the torus, columns x rows")->type_name("PxQ")->capture_default_str();
  command
      .add_option("--pe-memory", options.pe_memory, "Local memory of a PE in bytes, K = 1024, M = 1024 K; 256K to 64M")
      ->type_name("SIZE")
      ->capture_default_str();
  command.add_option("--machine", options.machine, "Parameters of the machine [built in]")->type_name("FILE.toml");
  add_machine_values_option(command, options.machine_values, "");
  command.add_option("--engine", options.engine, "What runs the PEs")->type_name("NAME")->capture_default_str();
  add_debugging_options(command, options.debugging, "");
  add_ideal_option(command, options.ideal, "");
  add_fault_options(command, options.faults, "");
  add_ending_options(command, options.ending);
  command.add_option("--threads", options.threads, "Threads of this computer that work for the machine [all cores]")
      ->type_name("N")
      ->check(CLI::Range(1U, 4096U));
  command.add_option("--stats", options.stats, "Statistics of the run, as JSON")->type_name("FILE");
  command.add_option("--stats-csv", options.stats_csv, "The same as tables (.csv), into this folder")
      ->type_name("FOLDER");
  add_rank_options(command, options.ranks, "");
  add_trace_options(command, options.trace, TracedRun::image, "");
  add_display_options(command, options.display, "");
  command.add_option("--report", options.report, "The run as one .html page: maps, time line, what limits it")
      ->type_name("FILE");
  command.add_flag("--quiet", options.quiet, "No summary; only what the PEs say");
}

RunOptions parse_run_options(const std::vector<std::string>& words) {
  RunOptions options;
  CLI::App command;
  add_run_options(command, options);
  parse_words(command, words);
  return options;
}

MachineSetup setup_from(const RunOptions& options) {
  MachineSetup setup;
  const auto pes = value_of("--pes", parse_pes, options.pes);
  setup.columns = pes[0];
  setup.rows = pes[1];
  setup.local_memory_bytes = value_of("--pe-memory", parse_memory, options.pe_memory);
  engine_named(options.engine);
  setup.engine = options.engine;
  setup.debugging = options.debugging;
  setup.threads = options.threads;
  setup.arguments = options.program.arguments;
  // Where no IMAGE is needed, what stands in its place is the program's.
  if (!options.images.others.empty() && names_each_pe(options.images, setup.columns * setup.rows))
    setup.arguments.insert(setup.arguments.begin(), options.images.others);
  setup.until = options.ending.until;
  if (options.machine) {
    setup.description = load_machine_description(*options.machine);
  }
  for (const std::string& value : options.machine_values) set_machine_value(setup.description, value);
  setup.description.ideal = either(setup.description.ideal, options.ideal);
  options.faults.apply_to(setup.description);
  setup.profile = options.profile;
  setup.interrupted = &interrupted;
  return setup;
}

}  // namespace torolux
