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

void print_summary(const MachineSetup& setup, const MachineFigures& figures, double wall_seconds) {
  std::uint64_t packets = 0;
  for (const PeFigures& pe : figures.pes) packets += pe.packets_delivered;
  std::cerr << "torolux: " << figures.pes.size() << " PEs halted at cycle " << grouped(figures.now) << " ("
            << significant(1e3 * static_cast<double>(figures.now) / setup.description.processor.clock_hertz, 4)
            << " ms of virtual time); " << grouped(figures.instructions()) << " instructions, " << grouped(packets)
            << " packets; " << duration(wall_seconds) << "\n";
}

/// Throws InputError where one result would be written over another, or over what is read.
void check_results_distinct(const RunOptions& options) {
  std::vector<NamedFile> written;
  if (options.stats) written.push_back({"--stats", *options.stats});
  if (options.trace.file) written.push_back({"--trace", *options.trace.file});
  if (options.report) written.push_back({"--report", *options.report});
  std::vector<NamedFile> read = {{"a file that is read", options.image}};
  if (options.machine) read.push_back({"--machine", *options.machine});
  check_distinct(written, read);
}

}  // namespace

RunEnd run_prepared(const RunOptions& options) {
  MachineSetup setup = setup_from(options);
  const Image image = load_image(options.image);
  check_results_distinct(options);
  if (options.stats) {
    check_file_writable(*options.stats);
  }
  if (options.stats_csv) {
    check_stats_folder(*options.stats_csv);
  }
  if (options.report) {
    check_file_writable(*options.report);
  }
  const InputFile image_file{"image", options.image, sha256_of_file(options.image)};
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
  const auto print = [&display](const PeText& text) {
    std::cout << "PE " << text.pe << " @ " << text.time << ": " << text.text << std::endl;
    if (display) display->say(text);
  };
  const auto progress = [&display](const Machine& machine, Cycles now) {
    return !interrupted() && (!display || display->show(machine, now));
  };
  const auto trace = trace_file(options.trace, TracedRun::image, setup.columns * setup.rows);
  if (trace) setup.watcher = &trace->watcher();
  const MachineFigures figures = run_displayed(
      display.get(), [&] { return run_traced(trace.get(), [&] { return run_image(setup, image, print, progress); }); });
  if (interrupted()) {
    return {kInterrupted, ""};
  }
  if (trace) {
    trace->finish();
    if (!trace->note().empty() && !options.quiet) std::cerr << "torolux: note: " << trace->note() << "\n";
  }
  const double wall_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  std::string statistics = run_stats_json(setup, image_file, figures, wall_seconds);
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
    print_summary(setup, figures, wall_seconds);
  }
  if (display) {
    display->finish(nullptr);
    keep_display(options.quiet, [&display](const std::function<bool()>& stop) { display->wait(stop); });
  }
  return {0, std::move(statistics)};
}

void add_run_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<RunOptions>();
  CLI::App* command = app.add_subcommand("run", "Run any firmware image and print what its PEs say");
  add_run_options(*command, *options);
  command->callback([options, &action] { action = [options] { return run_prepared(*options).exit_code; }; });
}

}  // namespace torolux
