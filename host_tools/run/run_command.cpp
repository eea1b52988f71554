// SPDX-License-Identifier: MIT
// `torolux run IMAGE.elf`: options enter; the PEs' text, statistics and a summary leave.
#include <CLI/CLI.hpp>
#include <chrono>
#include <filesystem>
#include <iostream>
#include <memory>
#include <optional>

#include "emulator/engines/engine.hpp"
#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/debugging_options.hpp"
#include "host_tools/cli/fault_options.hpp"
#include "host_tools/cli/ideal_option.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/run/run.hpp"

namespace torolux {
namespace {

struct RunOptions {
  std::string image;
  std::string pes = "4x4";
  std::string pe_memory = "1M";
  std::string engine = kDefaultEngine;
  std::optional<std::string> machine, stats;
  Debugging debugging;
  FaultOptions faults;
  MachineDescription::Ideal ideal;
  unsigned threads = 0;
  bool quiet = false;
};

/// `parse`'s errors do not name the option.
template <class Parse>
auto value_of(const char* option, Parse parse, const std::string& text) {
  try {
    return parse(text);
  } catch (const UsageError& error) {
    throw UsageError(std::string(option) + ": " + error.what());
  } catch (const InputError& error) {
    throw InputError(std::string(option) + ": " + error.what());
  }
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
  setup.debugging.listens = announce_debugger(options.image);
  setup.threads = options.threads;
  if (options.machine) {
    setup.description = load_machine_description(*options.machine);
  }
  setup.description.ideal = either(setup.description.ideal, options.ideal);
  options.faults.apply_to(setup.description);
  return setup;
}

void print_summary(const MachineSetup& setup, const MachineFigures& figures, double wall_seconds) {
  std::uint64_t packets = 0;
  for (const PeFigures& pe : figures.pes) packets += pe.packets_delivered;
  std::cerr << "torolux: " << figures.pes.size() << " PEs halted at cycle " << grouped(figures.now) << " ("
            << significant(1e3 * static_cast<double>(figures.now) / setup.description.processor.clock_hertz, 4)
            << " ms of virtual time); " << grouped(figures.instructions()) << " instructions, " << grouped(packets)
            << " packets; " << duration(wall_seconds) << "\n";
}

int run_run(const RunOptions& options) {
  const MachineSetup setup = setup_from(options);
  const Image image = load_image(options.image);
  if (options.stats) {
    check_file_writable(*options.stats);
  }
  const auto begin = std::chrono::steady_clock::now();
  const auto print = [](const PeText& text) {
    std::cout << "PE " << text.pe << " @ " << text.time << ": " << text.text << std::endl;
  };
  const MachineFigures figures = run_image(setup, image, print, [](Cycles) { return !interrupted(); });
  if (interrupted()) {
    return kInterrupted;
  }
  const double wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  if (options.stats) {
    write_file(*options.stats, run_stats_json(setup, figures, wall_seconds));
  }
  if (!options.quiet) {
    print_summary(setup, figures, wall_seconds);
  }
  return 0;
}

}  // namespace

void add_run_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Run any firmware image and print what its PEs say");
  command->add_option("IMAGE", options->image, "A firmware image (ELF for rv32imafc); see docs/writing_firmware.md")
      ->required()
      ->type_name("");
  command->add_option("--pes", options->pes, "PEs of the torus, columns x rows")
      ->type_name("PxQ")
      ->capture_default_str();
  command
      ->add_option("--pe-memory", options->pe_memory,
                   "Local memory of a PE in bytes, K = 1024, M = 1024 K; 256K to 64M")
      ->type_name("SIZE")
      ->capture_default_str();
  command->add_option("--machine", options->machine, "Parameters of the machine [built in]")->type_name("FILE.toml");
  command->add_option("--engine", options->engine, "What runs the PEs")->type_name("NAME")->capture_default_str();
  add_debugging_options(*command, options->debugging, "");
  add_ideal_option(*command, options->ideal, "");
  add_fault_options(*command, options->faults, "");
  command->add_option("--threads", options->threads, "Threads of this computer that work for the machine [all cores]")
      ->type_name("N")
      ->check(CLI::Range(1U, 4096U));
  command->add_option("--stats", options->stats, "Statistics of the run, as JSON")->type_name("FILE");
  command->add_flag("--quiet", options->quiet, "No summary; only what the PEs say");
  command->callback([options, &action] { action = [options] { return run_run(*options); }; });
}

}  // namespace torolux
