// SPDX-License-Identifier: MIT
// `torolux run IMAGE.elf`: options enter; the PEs' text, statistics and a summary leave.
#include <CLI/CLI.hpp>
#include <array>
#include <chrono>
#include <iostream>
#include <memory>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/run_options.hpp"
#include "host_tools/files/distinct_files.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/report/csv.hpp"
#include "host_tools/report/html_report.hpp"
#include "host_tools/report/text.hpp"
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
  std::cerr << "torolux: " << figures.pes.size() << " PEs halted at cycle " << grouped(figures.now) << " ("
            << significant(1e3 * static_cast<double>(figures.now) / setup.description.processor.clock_hertz, 4)
            << " ms of virtual time); " << grouped(figures.instructions()) << " instructions, " << grouped(packets)
            << " packets; " << duration(wall_seconds) << "\n";
}

/// Throws InputError where one result would be written over another, or over what is read.
void check_results_distinct(const RunOptions& options) {
  std::vector<NamedFile> written = written_files(options.program);
  if (options.stats) written.push_back({"--stats", *options.stats});
  if (options.trace.file) written.push_back({"--trace", *options.trace.file});
  if (options.report) written.push_back({"--report", *options.report});
  std::vector<NamedFile> read = read_files(options.program);
  read.push_back({"a file that is read", options.image});
  if (options.machine) read.push_back({"--machine", *options.machine});
  check_distinct(written, read);
}

}  // namespace

ProgramFiles program_files(const RunOptions& options, const std::vector<Input>& read) {
  ProgramFiles inputs;
  inputs.files.push_back({"image", options.image, sha256_of_file(options.image)});
  for (InputFile& input : digests_of(read)) inputs.files.push_back(std::move(input));
  for (const GivenFile& output : options.program.outputs) inputs.outputs.push_back(output.name);
  return inputs;
}

RunEnd run_prepared(const RunOptions& options) {
  MachineSetup setup = setup_from(options);
  const Image image = load_image(options.image);
  check_results_distinct(options);
  check_files(options.program);
  if (options.stats) {
    check_file_writable(*options.stats);
  }
  if (options.stats_csv) {
    check_stats_folder(*options.stats_csv);
  }
  if (options.report) {
    check_file_writable(*options.report);
  }
  std::vector<Input> read = read_inputs(options.program.inputs);
  const ProgramFiles inputs = program_files(options, read);
  ServedFiles files(std::move(read), options.program.outputs);
  const auto begin = std::chrono::steady_clock::now();
  const auto display = open_display(options.display, {"run",
                                                      std::filesystem::path(options.image).filename().string(),
                                                      setup.columns,
                                                      setup.rows,
                                                      setup.description.processor.clock_hertz,
                                                      0,
                                                      0,
                                                      {}});
  if (display) {
    setup.progress_seconds = DisplayFeed::kUpdateSeconds;
    setup.pacer = &display->pace();
    setup.hop_watcher = &display->pace();
  }
  const auto print = [&display, &options](const PeText& text) {
    print_text(text, options.program.raw);
    if (display) display->say(text);
  };
  const auto progress = [&display](const Machine& machine, Cycles now) {
    return !interrupted() && (!display || display->show(machine, now));
  };
  const auto trace = trace_file(options.trace, TracedRun::image, setup.columns * setup.rows);
  if (trace) setup.watcher = &trace->watcher();
  const RunOutcome outcome = run_displayed(display.get(), [&] {
    return run_traced(trace.get(), [&] { return run_program(setup, image, files, print, progress); });
  });
  const MachineFigures& figures = outcome.figures;
  if (interrupted()) {
    return {kInterrupted, ""};
  }
  files.finish();
  if (trace) {
    trace->finish();
    if (!trace->note().empty() && !options.quiet) std::cerr << "torolux: note: " << trace->note() << "\n";
  }
  const double wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::string statistics = run_stats_json(setup, inputs, figures, wall_seconds);
  if (options.stats) {
    write_file(*options.stats, statistics);
  }
  if (options.stats_csv) {
    write_stats_tables(*options.stats_csv, stats_tables(figures));
  }
  if (options.report) {
    write_file(*options.report, report_html({options.image, statistics, figures, nullptr, {}}));
  }
  if (!options.quiet) {
    print_summary(setup, outcome, wall_seconds);
  }
  if (display) {
    display->finish(nullptr);
    keep_display(options.quiet, [&display](const std::function<bool()>& stop) { display->wait(stop); });
  }
  return {outcome.first_exit ? outcome.first_exit->code() : 0, std::move(statistics)};
}

void add_run_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Run any firmware image and print what its PEs say");
  add_run_options(*command, *options);
  command->callback([options, &action] { action = [options] { return run_prepared(*options).exit_code; }; });
}

}  // namespace torolux
