// SPDX-License-Identifier: MIT
// `torolux rerun STATS.json`: the statistics of a run enter; the same run is done again, and whether it was the same
// leaves.
#include <CLI/CLI.hpp>
#include <array>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/prepared_render.hpp"
#include "host_tools/cli/run_options.hpp"
#include "host_tools/cli/same_run.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/report/settings_json.hpp"

namespace torolux {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostStatisticsBytes = std::size_t{1} << 30U;
constexpr std::size_t kMostDifferencesShown = 5;

struct RerunOptions {
  std::string statistics;
  std::vector<std::filesystem::path> outputs;
  std::optional<std::string> scene, radiosity, stats, engine;
  unsigned threads = 0;
  bool changed_inputs = false, quiet = false;
};

Json read_statistics(const std::string& file) {
  const std::vector<std::byte> bytes = read_file(file, kMostStatisticsBytes);
  const char* begin = reinterpret_cast<const char*>(bytes.data());
  Json json = Json::parse(begin, begin + bytes.size(), nullptr, false);
  if (json.is_discarded() || !json.is_object()) throw InputError(file + ": is not the JSON that --stats writes");
  if (!json.contains("settings") || !json["settings"].contains("inputs"))
    throw InputError(file + ": holds no settings that a run can be repeated by; it was written by an older version");
  return json;
}

/// The settings with the places of files that have moved.
Json moved(Json settings, const RerunOptions& options) {
  if (options.scene) {
    if (settings.contains("images")) throw UsageError("--scene: this run had several images; they have to be in place");
    const bool image = settings.contains("image");
    settings[image ? "image" : "scene_path"] = *options.scene;
  }
  for (Json& input : settings["inputs"]) {
    if (options.radiosity && input.value("role", "") == "radiosity") input["path"] = *options.radiosity;
  }
  return settings;
}

void say(const RerunOptions& options, const std::string& text) {
  if (!options.quiet) std::cerr << "torolux: " << text << "\n";
}

/// Where a file is no more, it may have moved.
template <class Action>
auto with_hint(const RerunOptions& options, Action action) {
  try {
    return action();
  } catch (const UsageError& error) {
    if (options.engine) throw;  // it may be that
    throw InputError(options.statistics + ": the settings cannot be repeated: " + error.what());
  } catch (const InputError& error) {
    throw InputError(std::string(error.what()) +
                     " (should the scene or image have moved, or the run have been started in another folder, name it "
                     "with --scene)");
  }
}

/// What is wrong in the settings is wrong in the file, not on this command line.
template <class Action>
auto from_settings(const RerunOptions& options, Action action) {
  const auto refuse = [&](const std::string& why) -> InputError {
    return InputError(options.statistics + ": the settings cannot be repeated: " + why);
  };
  try {
    return action();
  } catch (const UsageError& error) {
    throw refuse(error.what());
  } catch (const InputError& error) {
    throw refuse(error.what());
  } catch (const Json::exception& error) {
    throw refuse(error.what());
  }
}

/// Throws InputError where inputs have changed and that was not allowed; other changes are told.
void check_settings(const Json& was, const Json& is, const RerunOptions& options) {
  using Lines = std::vector<std::string>;
  const auto [inputs, versions, settings] = from_settings(options, [&] {
    return std::array<Lines, 3>{changed_inputs(was, is), changed_versions(was, is), changed_settings(was, is)};
  });
  for (const std::string& line : versions) say(options, "note: " + line);
  for (const std::string& line : settings) say(options, "note: settings." + line);
  if (inputs.empty()) return;
  std::string text;
  for (const std::string& line : inputs) text += (text.empty() ? "" : "; ") + line;
  if (!options.changed_inputs)
    throw InputError(options.statistics + ": cannot be repeated: " + text + "; --changed-inputs runs it all the same");
  say(options, "note: " + text);
}

RunEnd run_render_again(const Json& was, const std::vector<std::string>& words, const RerunOptions& options) {
  RenderOptions render = from_settings(options, [&] { return parse_render_options(words); });
  render.outputs = options.outputs;
  render.no_picture = options.outputs.empty();
  if (options.stats) render.stats = *options.stats;
  if (options.engine) render.given.set(&MachineChoice::engine, *options.engine);
  if (options.threads != 0) render.given.set(&MachineChoice::threads, options.threads);
  render.quiet = true;
  PreparedRender prepared = with_hint(options, [&] { return prepare_render(render); });
  check_settings(was, settings_json(prepared.run, nullptr), options);
  return run_prepared(prepared, render);
}

RunEnd run_image_again(const Json& was, const std::vector<std::string>& words, const RerunOptions& options) {
  RunOptions run = from_settings(options, [&] { return parse_run_options(words); });
  if (!options.outputs.empty()) throw UsageError("--output: `torolux run` makes no picture");
  run.stats = options.stats;
  run.engine = options.engine.value_or(run.engine);
  run.threads = options.threads;
  run.quiet = true;
  const MachineSetup setup = setup_from(run);
  const ProgramFiles inputs =
      with_hint(options, [&] { return program_files(run, setup, read_inputs(run.program.inputs)); });
  check_settings(was, settings_json(setup, inputs), options);
  return run_prepared(run);
}

/// Prints the verdict. True: the same run.
bool report(const Json& was, const Json& is, const RerunOptions& options) {
  const std::vector<std::string> lines = changed_figures(was, is);
  const auto same = [&](const char* key) { return was.contains(key) && is.contains(key) && was.at(key) == is.at(key); };
  const auto verdict = [&](const char* name, const char* key) {
    if (!options.quiet && was.contains(key)) std::cout << name << (same(key) ? "the same" : "NOT the same") << "\n";
  };
  verdict("cycles      ", "virtual_cycles");
  verdict("picture     ", "picture");
  verdict("trace hash  ", "trace_hash");
  for (std::size_t i = 0; i < lines.size() && i < kMostDifferencesShown; ++i)
    std::cerr << "torolux: " << (i == 0 ? "differs first in " : "and in ") << lines[i] << "\n";
  if (lines.size() > kMostDifferencesShown)
    std::cerr << "torolux: and in " << lines.size() - kMostDifferencesShown << " more figures\n";
  std::cout << std::flush;
  return lines.empty();
}

int run_rerun(const RerunOptions& options) {
  const Json was = read_statistics(options.statistics);
  std::vector<std::string> words =
      from_settings(options, [&] { return command_line_of(moved(was.at("settings"), options)); });
  const std::string command = words.front();
  words.erase(words.begin());
  const RunEnd end = command == "render" ? run_render_again(was.at("settings"), words, options)
                                         : run_image_again(was.at("settings"), words, options);
  if (end.statistics.empty()) return end.exit_code;
  const bool same = report(was, Json::parse(end.statistics), options);
  return static_cast<int>(same ? ExitCode::done : ExitCode::machine_failure);
}

void add_options(CLI::App& command, RerunOptions& options) {
  command.add_option("STATS", options.statistics, "Statistics that --stats of render or run has written")
      ->required()
      ->type_name("");
  command.add_option("--output", options.outputs, "Picture, as for render; may be repeated [none]")
      ->type_name("FILE")
      ->allow_extra_args(false);
  command.add_option("--stats", options.stats, "Statistics of this run, as JSON")->type_name("FILE");
  command.add_option("--engine", options.engine, "What runs the PEs [as it was]")->type_name("NAME");
  command.add_option("--threads", options.threads, "Threads of this computer that work for the machine [all cores]")
      ->type_name("N")
      ->check(CLI::Range(1U, 4096U));
  command.add_option("--scene", options.scene, "The scene or image, where it has moved")->type_name("PATH");
  command.add_option("--radiosity", options.radiosity, "The saved radiosity, where it has moved")->type_name("FILE");
  command.add_flag("--changed-inputs", options.changed_inputs, "Run even if scene, radiosity or firmware have changed");
  command.add_flag("--quiet", options.quiet, "Only what differs, and errors");
}

}  // namespace

void add_rerun_command(CLI::App& app, CommandAction& action) {
  const auto options = std::make_shared<RerunOptions>();
  CLI::App* command = app.add_subcommand("rerun", "Repeat a run from its statistics, and tell whether it was the same");
  add_options(*command, *options);
  command->callback([options, &action] { action = [options] { return run_rerun(*options); }; });
}

}  // namespace torolux
