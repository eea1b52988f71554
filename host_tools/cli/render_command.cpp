// SPDX-License-Identifier: MIT
// `torolux render SCENE`: options enter; pictures, statistics and a summary leave.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <memory>
#include <numeric>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/debugging_options.hpp"
#include "host_tools/cli/findings.hpp"
#include "host_tools/cli/firmware_image.hpp"
#include "host_tools/cli/growing_options.hpp"
#include "host_tools/cli/launch_options.hpp"
#include "host_tools/cli/measured_speed.hpp"
#include "host_tools/cli/path_frames.hpp"
#include "host_tools/cli/prepared_render.hpp"
#include "host_tools/cli/table_options.hpp"
#include "host_tools/display/walk.hpp"
#include "host_tools/files/distinct_files.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/profile/profile_json.hpp"
#include "host_tools/profile/profile_text.hpp"
#include "host_tools/render/session.hpp"
#include "host_tools/report/csv.hpp"
#include "host_tools/report/figures.hpp"
#include "host_tools/report/html_report.hpp"
#include "host_tools/report/progress_line.hpp"
#include "host_tools/run/debugged_run.hpp"
#include "host_tools/solution/ply_file.hpp"
#include "host_tools/trace/story.hpp"

namespace torolux {
namespace {

/// Of a path, one for each camera.
std::vector<std::filesystem::path> picture_files(const Resolved& resolved) {
  if (resolved.path.empty()) return resolved.outputs;
  std::vector<std::filesystem::path> files;
  for (const auto& file : resolved.outputs) {
    for (std::size_t i = 1; i <= resolved.path.size(); ++i) files.push_back(frame_file(file, i, resolved.path.size()));
  }
  return files;
}

/// Throws InputError where one result would be written over another, or over what is read.
void check_results_distinct(const PreparedRender& prepared, const RenderOptions& options) {
  std::vector<NamedFile> written;
  for (const auto& file : picture_files(prepared.resolved)) {
    written.push_back({"--output", file});
    if (holds_radiance(file)) continue;
    for (const LayerName& layer : layers_in(prepared.resolved.quality.layers))
      written.push_back({"a layer of --output", layer_file(file, layer.name)});
  }
  const auto add = [&written](const char* option, const std::optional<std::filesystem::path>& file) {
    if (file) written.push_back({option, *file});
  };
  add("--stats", options.stats);
  add("--report", options.report);
  add("--profile", options.profile);
  add("--save-radiosity", options.save_radiosity);
  add("--save-mesh", options.save_mesh);
  add("--trace", options.trace.file);
  add("--checkpoint", options.checkpoint.file);
  if (const auto& file = options.checkpoint.file)
    written.push_back({"the picture so far of --checkpoint", std::filesystem::path(*file).concat(".png")});
  std::vector<NamedFile> read;
  for (const InputFile& input : prepared.run.inputs.files) read.push_back({"a file that is read", input.path});
  if (options.machine) read.push_back({"--machine", *options.machine});
  check_distinct(written, read);
}

/// What cannot be written is better known before the work than after it.
void check_results_writable(const Resolved& resolved, const RenderOptions& options) {
  for (const auto& file : resolved.outputs) {
    const std::size_t frames = resolved.path.size();
    check_layers_writable(frames == 0 ? file : frame_file(file, 1, frames), resolved.quality.layers);
  }
  if (options.stats) check_file_writable(*options.stats);
  if (options.stats_csv) check_stats_folder(*options.stats_csv);
  if (options.report) check_report_writable(*options.report);
  if (options.profile) check_file_writable(*options.profile);
  if (options.save_radiosity) check_file_writable(*options.save_radiosity);
  if (options.save_mesh) check_ply_writable(*options.save_mesh);
  if (options.checkpoint.file) check_file_writable(*options.checkpoint.file);
}

/// What tells of a run from its beginning cannot begin in its midst.
void check_told_whole(const RenderOptions& options) {
  if (!options.checkpoint.resume) return;
  if (options.trace.file || options.follow || options.profile)
    throw UsageError("--trace, --follow and --profile tell of a whole run: not of one that goes on by --resume");
}

void print_notes(const std::vector<std::string>& notes, bool quiet) {
  if (quiet) return;
  for (const std::string& note : notes) std::cerr << "torolux: note: " << note << "\n";
}

/// Where it is interrupted, its state has been saved.
void tell_of_checkpoint(const RenderOptions& options) {
  if (options.checkpoint.file)
    print_notes({"the state is in " + options.checkpoint.file->string() + "; the same with --resume " +
                 options.checkpoint.file->string() + " goes on"},
                options.quiet);
}

std::unique_ptr<Display> display_of(const PreparedRender& prepared, const RenderOptions& options) {
  const Resolved& resolved = prepared.resolved;
  return open_display(options.display, {"render", prepared.run.scene, resolved.machine.columns, resolved.machine.rows,
                                        resolved.machine.description.processor.clock_hertz, resolved.quality.width,
                                        resolved.quality.height, resolved.tone});
}

/// A render while it goes on, as terminal, display and growing picture (null: none) show it. False: it is to end.
class Shown {
 public:
  Shown(const Resolved& resolved, const RenderOptions& options, Display* display, GrowingPicture* growing)
      : line_(std::cerr, !options.quiet && ::isatty(STDERR_FILENO) == 1,
              resolved.machine.description.processor.clock_hertz, options.verbose),
        display_(display),
        growing_(growing) {}

  bool show(const RenderProgress& progress) {
    if (interrupted()) {
      if (display_ != nullptr) display_->pace().go_free();  // it may have to go on until its state can be saved
      return false;
    }
    line_.show(progress);
    if (growing_ != nullptr) growing_->show(progress);
    return display_ == nullptr || display_->show(progress);
  }
  /// Of a path.
  bool show(std::size_t picture, std::size_t of) {
    if (interrupted()) return false;
    line_.show("picture " + std::to_string(picture) + " of " + std::to_string(of));
    return true;
  }
  void wipe() { line_.wipe(); }

 private:
  ProgressLine line_;
  Display* display_;
  GrowingPicture* growing_;
};

/// The first picture, and those of a path behind it.
RenderResult run_session(RenderSession& session, const Resolved& resolved, Shown& shown, bool stays) {
  RenderResult result = session.run(stays ? Machine::Then::stay : Machine::Then::end);
  shown.wipe();
  if (interrupted() || resolved.path.empty()) return result;
  render_path(session, resolved, result,
              [&shown](std::size_t number, std::size_t count) { return shown.show(number, count); });
  shown.wipe();
  return result;
}

void finish_trace(TraceFile& trace, bool quiet) {
  trace.finish();
  if (!trace.note().empty()) print_notes({trace.note()}, quiet);
}

void finish_growing(GrowingPicture& growing, const RenderResult& result, bool quiet) {
  const std::string note = growing.finish(result.picture, result.layers);
  if (!note.empty()) print_notes({note}, quiet);
}

void keep_checkpoints(PreparedRender& prepared, const CheckpointOptions& options) {
  Resolved& resolved = prepared.resolved;
  resolved.files.checkpoint = checkpoint_choice(options, prepared.run);
  if (!options.file) return;
  resolved.files.picture_so_far = [&resolved, so_far = std::filesystem::path(*options.file).concat(".png")](
                                      const Picture& picture) { write_layers(picture, {}, so_far, resolved.tone); };
}

void show_on(Display& display, MachineChoice& machine) {
  machine.progress_seconds = DisplayFeed::kUpdateSeconds;
  machine.pacer = &display.pace();
  machine.hop_watcher = &display.pace();
}

void write_results(const PreparedRender& prepared, const RenderOptions& options, const RenderResult& result,
                   const std::string& statistics, const std::string& profile) {
  const Resolved& resolved = prepared.resolved;
  if (resolved.path.empty()) {
    for (const auto& file : resolved.outputs) write_layers(result.picture, result.layers, file, resolved.tone);
  }
  if (options.stats) write_file(*options.stats, statistics);
  if (options.stats_csv) write_stats_tables(*options.stats_csv, stats_tables(result.figures));
  if (options.report) {
    write_file(*options.report, report_html({prepared.run.scene, statistics, result.figures.machine, &result.picture,
                                             resolved.tone, profile}));
  }
  if (!options.quiet) std::cout << summary(prepared.run, result.figures) << std::flush;
}

/// Of all PEs together: into its file, and for the report; empty: there is none.
std::string write_profile(const RenderOptions& options, const profile::CycleProfile& profile) {
  if (!options.profile) return "";
  const ProfileNames names(profile);
  std::vector<unsigned> pes(profile.pes());
  std::iota(pes.begin(), pes.end(), 0U);
  const PathTree tree = paths_of(profile, names, pes);
  write_file(*options.profile, folded_paths(tree, names));
  return flame_graph_json(tree, names, pes.size());
}

/// Pages may look at the solved scene from elsewhere, and ask.
void walk_about(const PreparedRender& prepared, RenderSession& session, Display& display, bool quiet) {
  const Resolved& resolved = prepared.resolved;
  keep_display(quiet, [&](const std::function<bool()>& stop) {
    Questions questions(prepared.scene, resolved.quality, resolved.machine, session);
    Walk(session, display, resolved.camera, resolved.quality, questions).go(stop);
  });
}

/// What tells of PEs as only their own process can.
void check_goes_with_ranks(const RenderOptions& options) {
  refuse_on_ranks(options.trace.file.has_value(), "--trace");
  refuse_on_ranks(options.profile.has_value(), "--profile");
  refuse_on_ranks(options.display.display, "--display");
}

/// ranks: run the PEs; null: this process does.
int render_on(remote::PeRanks* ranks, const RenderOptions& options) {
  if (ranks != nullptr) check_goes_with_ranks(options);
  PreparedRender prepared = prepare_render(options);
  prepared.resolved.machine.ranks = ranks;
  try {
    return run_prepared(prepared, options).exit_code;
  } catch (const StateSaved&) {
    tell_of_checkpoint(options);
    return kInterrupted;
  }
}

}  // namespace

RunEnd run_prepared(PreparedRender& prepared, const RenderOptions& options) {
  Resolved& resolved = prepared.resolved;
  resolved.machine.debugging.listens = announce_debugger([](unsigned) { return firmware_image(); });
  check_told_whole(options);
  check_results_distinct(prepared, options);
  check_results_writable(resolved, options);
  print_notes(prepared.scene.warnings, options.quiet);
  print_notes(prepared.findings, options.quiet);
  if (interrupted()) return {kInterrupted, ""};
  const auto trace = trace_file(options.trace, TracedRun::render, resolved.machine.columns * resolved.machine.rows);
  std::optional<Story> story;
  if (options.follow) resolved.machine.follower = &story.emplace(*options.follow);
  if (trace) resolved.machine.watcher = &trace->watcher();
  profile::CycleProfile profile;
  if (options.profile) resolved.machine.profile = &profile;
  keep_checkpoints(prepared, options.checkpoint);
  const auto from = checkpoint_to_resume(options.checkpoint, prepared.run);
  resolved.files.resume = from.get();
  const auto display = display_of(prepared, options);
  if (display) show_on(*display, resolved.machine);
  const auto growing = growing_picture(options.growing, prepared.run.scene, resolved);
  Shown shown(resolved, options, display.get(), growing.get());
  const std::function<bool(const RenderProgress&)> show = [&shown](const RenderProgress& p) { return shown.show(p); };
  const auto debugger = open_debugger(
      resolved.machine.debugging, resolved.machine.columns, resolved.machine.rows,
      [](unsigned) { return std::filesystem::path(firmware_image()); }, false);
  RenderSession session(prepared.scene, resolved.camera, resolved.quality, resolved.machine, resolved.files,
                        firmware_image(), show);
  const bool stays = resolved.path.size() > 1 || display;
  const RenderResult result = run_displayed(display.get(), [&] {
    return run_traced(trace.get(), [&] {
      return run_with_debugger(debugger.get(), [&] { return run_session(session, resolved, shown, stays); });
    });
  });
  if (interrupted()) return {kInterrupted, ""};
  if (trace) finish_trace(*trace, options.quiet);
  if (story) {
    for (const std::string& line : story->lines()) std::cout << line << "\n";
  }
  if (!from && resolved.machine.ranks == nullptr) remember_speed(resolved.machine, result.figures);
  print_notes(result.notes, options.quiet);
  print_notes(findings_after(prepared.scene, result), options.quiet);
  if (growing) finish_growing(*growing, result, options.quiet);

  std::string statistics = stats_json(prepared.run, result.figures);
  write_results(prepared, options, result, statistics, write_profile(options, profile));
  if (display) {
    display->finish(&result.picture);
    walk_about(prepared, session, *display, options.quiet);
  }
  return {0, std::move(statistics)};
}

void add_render_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<RenderOptions>();
  CLI::App* command = app.add_subcommand("render", "Render a picture of a scene on the machine");
  add_render_options(*command, *options);
  add_launch_options(*command, heading(OptionGroup::machine));
  command->footer("An option given outweighs the scene's own default, which outweighs the one in [brackets].");
  command->callback([options, &action] {
    action = [options] {
      return run_on_ranks(options->ranks, [&](remote::PeRanks* ranks) { return render_on(ranks, *options); });
    };
  });
}

}  // namespace torolux
