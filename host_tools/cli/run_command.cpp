// SPDX-License-Identifier: MIT
// `torolux run IMAGE.elf`: options enter; the PEs' text, statistics and a summary leave.
#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <iostream>
#include <memory>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/debugging_options.hpp"
#include "host_tools/cli/launch_options.hpp"
#include "host_tools/cli/run_options.hpp"
#include "host_tools/files/distinct_files.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/report/csv.hpp"
#include "host_tools/report/html_report.hpp"
#include "host_tools/report/text.hpp"
#include "host_tools/run/debugged_run.hpp"
#include "host_tools/run/run.hpp"

namespace torolux {
namespace {

void print_summary(const MachineSetup& setup, const RunOutcome& outcome, double wall_seconds) {
  const MachineFigures& figures = outcome.figures;
  if (const auto& exit = outcome.first_exit) {
    std::cerr << "torolux: PE " << exit->pe << " ended with exit status " << exit->status << " at cycle "
              << grouped(exit->time) << ": the first that is not 0\n";
  }
  std::uint64_t packets = 0;
  for (const PeFigures& pe : figures.pes) packets += pe.packets_delivered;
  std::cerr << "torolux: " << figures.pes.size() << (figures.pes.size() == 1 ? " PE " : " PEs ")
            << (figures.stopped ? "stopped by --until at cycle " : "halted at cycle ") << grouped(figures.now) << " ("
            << significant(1e3 * static_cast<double>(figures.now) / setup.description.processor.clock_hertz, 4)
            << " ms of virtual time); " << grouped(figures.instructions()) << " instructions, " << grouped(packets)
            << " packets; " << duration(wall_seconds) << "\n";
}

/// Throws InputError where a result cannot be written, or would be written over another or over what is read.
void check_results(const RunOptions& options, const RunImages& images) {
  std::vector<NamedFile> written = written_files(options.program);
  if (options.stats) written.push_back({"--stats", *options.stats});
  if (options.trace.file) written.push_back({"--trace", *options.trace.file});
  if (options.report) written.push_back({"--report", *options.report});
  for (NamedFile& file : files_of(options.ending.dumps)) written.push_back(std::move(file));
  std::vector<NamedFile> read = read_files(options.program);
  for (const InputFile& image : images.files) read.push_back({"a file that is read", image.path});
  if (options.machine) read.push_back({"--machine", *options.machine});
  check_distinct(written, read);
  check_files(options.program);
  if (options.stats) check_file_writable(*options.stats);
  if (options.stats_csv) check_stats_folder(*options.stats_csv);
  if (options.report) check_report_writable(*options.report);
}

void write_results(const RunOptions& options, const RunImages& images, const MachineFigures& figures,
                   const std::string& statistics) {
  if (options.stats) write_file(*options.stats, statistics);
  if (options.stats_csv) write_stats_tables(*options.stats_csv, stats_tables(figures));
  if (options.report) {
    const std::string profile = options.profile_for_report ? options.profile_for_report() : "";
    write_file(*options.report, report_html({images.paths(), statistics, figures, nullptr, {}, profile}));
  }
}

/// Null where none is asked for; else it shows the machine to be, which goes at its pace.
std::unique_ptr<Display> open_run_display(const RunOptions& options, const RunImages& files, const ImageSet& images,
                                          MachineSetup& setup) {
  auto display = open_display(options.display, {"run",
                                                files.names(),
                                                setup.columns,
                                                setup.rows,
                                                setup.description.processor.clock_hertz,
                                                0,
                                                0,
                                                {},
                                                images.phase_names()});
  if (display) {
    setup.progress_seconds = DisplayFeed::kUpdateSeconds;
    setup.pacer = &display->pace();
    setup.hop_watcher = &display->pace();
  }
  return display;
}

/// The run, watched by whom the options name; nothing where Ctrl-C has ended it. Files of programs are written then.
std::optional<RunOutcome> run_watched(const RunOptions& options, MachineSetup& setup, const ImageSet& images,
                                      std::vector<Input> read, const std::vector<MemoryDump>& dumps, Display* display) {
  const Timeout timeout(options.ending.timeout);
  const auto debugger = open_debugger(
      setup.debugging, setup.columns, setup.rows, [&images](unsigned pe) { return images.of(pe).file; },
      !options.trace.file && display == nullptr, [&timeout] { return timeout.while_held(); });
  const auto print = [display, &options, &debugger](const PeText& text) {
    if (debugger && !debugger->is_new()) return;
    print_text(text, options.program.raw);
    if (display != nullptr) display->say(text);
  };
  const auto progress = [display, &timeout](const Machine& machine, Cycles now) {
    timeout.check(machine, now);
    return !interrupted() && (display == nullptr || display->show(machine, now));
  };
  const auto trace = trace_file(options.trace, TracedRun::image, setup.columns * setup.rows);
  if (trace) setup.watcher = &trace->watcher();
  const auto at_end = [&dumps](const Machine& machine) { write_dumps(machine, dumps); };
  std::optional<ServedFiles> files;
  const auto run = [&](SnapshotReader* from) {
    files.emplace(debugger ? read : std::move(read), options.program.outputs);  // anew where a debugger goes back
    return run_program(setup, images, *files, print, progress, at_end, from);
  };
  RunOutcome outcome = run_displayed(
      display, [&] { return run_traced(trace.get(), [&] { return run_debugged(debugger.get(), run); }); });
  if (interrupted()) return std::nullopt;
  for (const std::string& unused : files->finish()) {
    if (!options.quiet)
      std::cerr << "torolux: note: --output " << unused << ": no PE has opened it; nothing is written\n";
  }
  if (trace) {
    trace->finish();
    if (!trace->note().empty() && !options.quiet) std::cerr << "torolux: note: " << trace->note() << "\n";
  }
  return outcome;
}

}  // namespace

ProgramFiles program_files(const RunOptions& options, const MachineSetup& setup, const std::vector<Input>& read) {
  ProgramFiles inputs{images_of(options.images, setup.columns * setup.rows), digests_of(read), {}};
  for (const GivenFile& output : options.program.outputs) inputs.outputs.push_back(output.name);
  return inputs;
}

RunEnd run_prepared(const RunOptions& options, remote::PeRanks* ranks) {
  MachineSetup setup = setup_from(options);
  setup.ranks = ranks;
  refuse_on_ranks(ranks != nullptr && options.trace.file, "--trace");
  refuse_on_ranks(ranks != nullptr && options.display.display, "--display");
  std::vector<Input> read = read_inputs(options.program.inputs);
  const ProgramFiles inputs = program_files(options, setup, read);
  const ImageSet images = load_images(inputs.images);
  setup.debugging.listens = announce_debugger([&images](unsigned pe) { return images.of(pe).file; });
  check_results(options, inputs.images);
  const std::vector<MemoryDump> dumps = checked_dumps(options.ending, setup, images);
  const auto begin = std::chrono::steady_clock::now();
  const auto display = open_run_display(options, inputs.images, images, setup);
  const std::optional<RunOutcome> outcome = run_watched(options, setup, images, std::move(read), dumps, display.get());
  if (!outcome) return {kInterrupted, ""};
  const double wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::string statistics = run_stats_json(setup, inputs, outcome->figures, wall_seconds);
  write_results(options, inputs.images, outcome->figures, statistics);
  if (!options.quiet) print_summary(setup, *outcome, wall_seconds);
  if (display) {
    display->finish(nullptr);
    keep_display(options.quiet, [&display](const std::function<bool()>& stop) { display->wait(stop); });
  }
  return {outcome->first_exit ? outcome->first_exit->code() : 0, std::move(statistics)};
}

void add_run_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Run any firmware image and print what its PEs say");
  add_run_options(*command, *options);
  add_launch_options(*command, "");
  command->callback([options, &action] {
    action = [options] {
      return run_on_ranks(options->ranks,
                          [&](remote::PeRanks* ranks) { return run_prepared(*options, ranks).exit_code; });
    };
  });
}

}  // namespace torolux
