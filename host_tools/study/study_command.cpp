// SPDX-License-Identifier: MIT
// `torolux study PLAN.toml...`: plans enter; of each, results, a table and curves leave.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <optional>
#include <thread>

#include "emulator/errors.hpp"
#include "emulator/nearest_name.hpp"
#include "emulator/ranks/launched.hpp"
#include "emulator/ranks/mpi_ranks.hpp"
#include "emulator/ranks/starter.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/cli/launch_options.hpp"
#include "host_tools/files/shell_line.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/study/claim.hpp"
#include "host_tools/study/figures.hpp"
#include "host_tools/study/local_hands.hpp"
#include "host_tools/study/options.hpp"
#include "host_tools/study/plots.hpp"
#include "host_tools/study/rank_hands.hpp"
#include "host_tools/study/report_names.hpp"
#include "host_tools/study/runner.hpp"
#include "host_tools/study/serve.hpp"
#include "host_tools/study/shard.hpp"

namespace torolux::study {
namespace {

struct StudyOptions {
  std::vector<std::string> plans;
  std::optional<std::string> folder;
  unsigned jobs = 0;  ///< 0: all cores
  bool dry_run = false, print_commands = false, quiet = false;
  std::optional<Shard> shard;
  std::string format = "summary";
};

/// A plan with its runs; equal ones share a key.
struct Study {
  Plan plan;
  ResultFolder folder;
  std::vector<Point> points;
  std::vector<std::string> keys;  ///< by point
  std::vector<Work> work;         ///< each key once, in the order of its first point
  std::map<std::string, Json> results;

  /// What is there, as far as it is not known.
  void read_results() {
    for (const Work& one : work) {
      if (results.contains(one.run.key)) continue;
      if (auto result = folder.read(one.run)) results.emplace(one.run.key, std::move(*result));
    }
  }
  std::vector<Work> missing() const {
    std::vector<Work> rest;
    std::ranges::copy_if(work, std::back_inserter(rest), [&](const Work& w) { return !results.contains(w.run.key); });
    return rest;
  }
};

std::filesystem::path folder_of(const std::string& plan, const StudyOptions& options) {
  if (options.folder) return *options.folder;
  return std::filesystem::path(plan).replace_extension(".study");
}

Study read_study(const std::string& file, const StudyOptions& options) {
  Plan plan = read_plan(file);
  ResultFolder folder(folder_of(file, options), plan.command);
  Study study{std::move(plan), std::move(folder), {}, {}, {}, {}};
  study.points = points_of(study.plan);
  check_report_names(study.plan);
  check_baseline(study.plan, study.points);
  const std::string program = program_digest();
  const std::vector<std::string> varied = varied_names(study.plan);
  std::map<std::string, bool> seen;
  for (const Point& point : study.points) {
    if (interrupted()) throw Interrupted("");
    KeyedRun run = keyed_run(study.plan, point, program);
    study.keys.push_back(run.key);
    if (seen.emplace(run.key, true).second) study.work.push_back({std::move(run), label_of(point, varied)});
  }
  return study;
}

std::string program_path() {
  return std::filesystem::read_symlink("/proc/self/exe").string();
}

void print_commands(const Study& study, const std::vector<Work>& work) {
  for (const Work& one : work) {
    std::vector<std::string> words = words_for_result(one.run, study.folder, study.plan.threads);
    words.insert(words.begin(), program_path());
    std::string line = shell_line(words);
    if (study.folder.from_output()) {
      const std::string file = study.folder.file(one.run.key).string();
      line += " > " + shell_line({file + ".part"}) + " && mv " + shell_line({file + ".part", file});
    }
    std::cout << line << "\n";
  }
}

void print_dry_run(const Study& study, const std::vector<Work>& work) {
  std::vector<Work> ordered = work;
  std::ranges::stable_sort(ordered, std::greater<>(), [](const Work& w) { return w.run.work; });
  for (const Work& one : ordered) std::cout << "run  " << one.run.key.substr(0, 12) << "  " << one.label << "\n";
  for (const Work& one : study.work) {
    if (study.results.contains(one.run.key))
      std::cout << "done " << one.run.key.substr(0, 12) << "  " << one.label << "\n";
  }
}

/// Names that no result knows are most likely slips; a result tells which names there are.
void check_names(const Table& table, const Study& study, const std::vector<std::string>& names) {
  if (study.results.empty()) return;
  std::vector<std::string> known = derived_names();
  const Json keys = study.results.begin()->second.flatten();
  for (const auto& [pointer, value] : keys.items()) {
    std::string name = pointer.substr(1);
    std::ranges::replace(name, '/', '.');
    known.push_back(name);
  }
  known.insert(known.end(), table.columns.begin(), table.columns.begin() + static_cast<std::ptrdiff_t>(table.varied));
  for (const std::string& name : names) {
    const std::size_t column = table.column(name);
    const bool empty = column >= table.columns.size() ||
                       std::ranges::all_of(table.rows, [&](const auto& row) { return row[column].is_null(); });
    if (!empty || name.empty() || std::ranges::find(known, name) != known.end()) continue;
    const std::string near = nearest_name(name, known);
    throw InputError(study.plan.file.string() + ": [report]: no run has a figure '" + name + "'" +
                     (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }
}

void write_outputs(const Study& study, const StudyOptions& options) {
  const Axes axes = axes_of(study.plan);
  std::vector<std::string> figures = axes.y;
  const std::vector<std::string> varied = varied_names(study.plan);
  const bool x_varies = axes.x == "value" || std::ranges::find(varied, axes.x) != varied.end();
  if (!axes.x.empty() && !x_varies) figures.push_back(axes.x);
  const Table table = make_table(study.plan, study.points, study.keys, study.results, figures);
  write_file(study.folder.path() / "results.csv", csv_of(table));
  const std::vector<std::string> shown =
      axes.y.empty()
          ? std::vector(table.columns.begin() + static_cast<std::ptrdiff_t>(table.varied), table.columns.end())
          : axes.y;
  if (options.format == "markdown") {
    if (options.plans.size() > 1) std::cout << "## " << study.plan.file.string() << "\n\n";
    std::cout << markdown_of(table, shown) << (options.plans.size() > 1 ? "\n" : "");
  }
  if (options.format == "csv") std::cout << csv_of(table);
  std::cout << std::flush;
  std::vector<std::string> names = axes.y;
  names.insert(names.end(), {axes.x, study.plan.report.by});
  check_names(table, study, names);
  if (axes.x.empty()) return;
  for (const std::string& y : shown) {
    const std::string script = plot_script(study.plan, table, axes.x, y);
    if (!script.empty()) write_file(study.folder.path() / plot_file(y), draw(script));
  }
}

void tell(const StudyOptions& options, const std::string& text) {
  if (!options.quiet) std::cerr << "torolux: " << text << "\n" << std::flush;
}

std::string counted(std::size_t count, const char* noun) {
  return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
}

/// Of processes that died; whoever lives keeps its own.
void remove_stale_locks(const Study& study) {
  for (const Work& one : study.work) {
    const std::filesystem::path lock = study.folder.lock(one.run.key);
    if (study.results.contains(one.run.key) && std::filesystem::exists(lock)) Claim::take(lock);
  }
}

int finish(Study& study, const StudyOptions& options, const RunnerEnd& end, std::size_t there) {
  study.read_results();
  remove_stale_locks(study);
  const std::size_t missing = study.missing().size();
  tell(options, counted(study.points.size(), "point") + ", " + counted(study.work.size(), "different run") + ": " +
                    std::to_string(there) + " were there, " + std::to_string(end.started) + " started, " +
                    std::to_string(end.failures.size()) + " failed" +
                    (missing > 0 ? ", " + std::to_string(missing) + " missing" : ""));
  if (end.interrupted) return kInterrupted;
  if (missing > 0 && end.failures.empty()) {
    tell(options, "the table and the curves are written once all results are there");
    return 0;
  }
  write_outputs(study, options);
  return static_cast<int>(end.failures.empty() ? ExitCode::done : ExitCode::machine_failure);
}

/// others: of the ranks beside this one; null: there are none.
int run_study(const std::string& plan, const StudyOptions& options, Hands* others) {
  Study study = read_study(plan, options);
  study.read_results();
  std::vector<Work> work = study.missing();
  if (options.shard) keep_shard(work, study.work, *options.shard);
  if (options.dry_run || options.print_commands) {
    if (options.print_commands) study.folder.make();
    options.print_commands ? print_commands(study, work) : print_dry_run(study, work);
    std::cout << std::flush;
    return 0;
  }
  study.folder.make();
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  const unsigned jobs = options.jobs != 0 ? options.jobs : std::max(1U, cores / study.plan.threads);
  const std::size_t there = study.results.size();
  LocalHands own(running_program(), jobs, false);
  std::vector<Hands*> hands = {&own};
  if (others != nullptr) hands.push_back(others);
  const RunnerEnd end = run_all(work, study.folder, {program_path(), study.plan.threads, hands});
  return finish(study, options, end, there);
}

/// Each is done, whatever became of those before it; the exit code is that of the first that failed.
int run_studies(const StudyOptions& options, Hands* others) {
  if (options.plans.size() > 1 && options.folder) throw UsageError("--folder: a folder is for one plan");
  if (options.plans.size() > 1 && options.format == "csv") throw UsageError("--format csv: a table is of one plan");
  int code = 0;
  for (const std::string& plan : options.plans) {
    if (options.plans.size() > 1) tell(options, plan);
    const int of_plan = run_study(plan, options, others);
    if (of_plan == kInterrupted) return of_plan;
    if (code == 0) code = of_plan;
  }
  return code;
}

/// One run at a time for each rank, since mpirun starts as many ranks as there are cores to use. What goes wrong here
/// is told before the others end: where one of them is lost, they take this process along.
int run_on_ranks(StudyOptions options) {
  options.jobs = std::max(1U, options.jobs);
  const std::unique_ptr<ranks::Transport> transport = ranks::join_mpi();
  if (transport->ranks().own != 0) {
    LocalHands own(running_program(), options.jobs, true);
    serve(*transport, own, program_digest());
    forget_interruption();  // rank 0 knows of it, and its exit code counts
    return 0;
  }
  RankHands others(*transport, options.jobs, program_digest());
  const int code = guarded([&] { return run_studies(options, &others); });
  ranks::tell_starter(code);
  others.end(code);
  return code;
}

int run(const StudyOptions& options) {
  return ranks::launched_ranks().count > 1 ? run_on_ranks(options) : run_studies(options, nullptr);
}

void add_options(CLI::App& command, StudyOptions& options) {
  command.add_option("PLAN", options.plans, "Plans of runs (TOML), done one after the other; see docs/studies.md")
      ->required()
      ->type_name("...");
  command.add_option("--folder", options.folder, "Where results lie [beside the plan, .study in place of .toml]")
      ->type_name("FOLDER");
  command
      .add_option("--jobs", options.jobs,
                  "Runs at once [all cores over the threads of a run; with --ranks or mpirun 1 of each rank]")
      ->type_name("N")
      ->check(CLI::Range(1U, 4096U));
  command.add_flag("--dry-run", options.dry_run, "Run nothing; print what would run, and what is there");
  command.add_flag("--print-commands", options.print_commands,
                   "Run nothing; print a command for each run that is missing, for a shell or GNU parallel");
  command
      .add_option_function<std::string>(
          "--shard", [&options](const std::string& text) { options.shard = parse_shard(text); },
          "Do part I of N of the runs only, for job arrays")
      ->type_name("I/N");
  command.add_option("--format", options.format, "What goes to standard output: summary (nothing), csv or markdown")
      ->type_name("NAME")
      ->check(CLI::IsMember({"summary", "csv", "markdown"}))
      ->capture_default_str();
  command.add_flag("--quiet", options.quiet, "No summary; errors only");
}

}  // namespace
}  // namespace torolux::study

namespace torolux {

void add_study_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<study::StudyOptions>();
  CLI::App* command =
      app.add_subcommand("study", "Do the runs of plans that are not done yet; write a table and curves of each");
  study::add_options(*command, *options);
  add_launch_options(*command, "");
  command->callback([options, &action] { action = [options] { return study::run(*options); }; });
}

}  // namespace torolux
