// SPDX-License-Identifier: MIT
// A command line enters, an exit code leaves; on the way the subcommand's work, or a message of what was wrong.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <exception>
#include <iostream>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "emulator/engines/engine_names.hpp"
#include "emulator/errors.hpp"
#include "emulator/ranks/launched.hpp"
#include "emulator/ranks/starter.hpp"
#include "firmware/protocol/machine.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/help_format.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/cli/launch_options.hpp"
#include "host_tools/cli/own_scenes.hpp"
#include "host_tools/cli/parse_error.hpp"
#include "host_tools/launch/launch.hpp"
#include "host_tools/report/version.hpp"
#include "host_tools/scene/keep_on.hpp"

namespace torolux {
namespace {

int code(ExitCode exit_code) {
  return static_cast<int>(exit_code);
}

/// What `torolux --version` prints.
std::string version_text() {
  const std::string commit = program_commit();
  std::string engines;
  for (const std::string_view name : engine_names()) {
    engines += (engines.empty() ? "" : ", ") + std::string(name);
    if (name == kDefaultEngine) engines += " (default)";
  }
  return std::string("torolux ") + kVersion + "\ncommit: " + (commit.empty() ? "unknown" : commit) +
         "\nprotocol: " + std::to_string(protocol::kProtocolVersion) + "\nengines: " + engines;
}

/// What `torolux` alone prints: where to begin.
std::string first_steps() {
  std::string scenes;
  for (const std::string& name : own_scenes()) scenes += " " + name;
  return "Torolux: a massively parallel machine for image synthesis, emulated\n\n"
         "  torolux render cornell_box    a first picture, cornell_box.png, and what the machine took\n"
         "  torolux info cornell_box      what a scene holds and what a machine needs for it\n"
         "  torolux --help                all commands\n"
         "  torolux render --help         all options of a command\n" +
         (scenes.empty() ? "" : "\nScenes that are here:" + scenes + "\n");
}

/// What does not know of ranks would do the same work, and write the same files, once for each.
void refuse_copies(const CLI::App& app) {
  const unsigned count = ranks::launched_ranks().count;
  if (count == 1) return;
  for (const char* const name : {"study", "render", "run"}) {
    if (app.got_subcommand(name)) return;
  }
  throw UsageError("mpirun would run '" + app.get_subcommands().front()->get_name() + "' " + std::to_string(count) +
                   " times: start it without mpirun; only 'render', 'run' and 'study' share their work out to ranks");
}

int run(CLI::App& app, const CommandAction& action, int argc, const char* const* argv) {
  std::vector<std::string> words(argv + std::min(argc, 1), argv + argc);
  // `help`, `help render`: as `--help`, `render --help`.
  if (!words.empty() && words[0] == "help") {
    words.erase(words.begin());
    if (const std::string wrong = unknown_command(app, words); !wrong.empty()) throw UsageError(wrong);
    words.emplace_back("--help");
  }
  if (words.empty()) {
    std::cout << first_steps();
    return code(ExitCode::done);
  }
  if (words[0] == "cc") {
    if (const std::optional<int> done = run_cc_command({words.begin() + 1, words.end()})) return *done;
    words = {"cc", "--help"};
  }
  try {
    app.parse(std::vector<std::string>(words.rbegin(), words.rend()));  // as CLI11 takes them
  } catch (const CLI::Success& asked) {
    return app.exit(asked);
  } catch (const CLI::ParseError& error) {
    throw UsageError(parse_error_text(app, words, error));
  }
  refuse_copies(app);
  if (const auto choice = launch_asked(*app.get_subcommands().front())) return launch::run_ranks(*choice, words);
  return action();
}

/// What has been written is there, or the run has failed: nobody takes half a table for a whole one.
int flushed(int result) {
  errno = 0;
  const bool failed_before = !std::cout;
  std::cout.flush();
  if (std::cout) return result;
  const std::string why = failed_before || errno == 0 ? "" : std::string(": ") + std::strerror(errno);
  std::cerr << "torolux: standard output could not be written" << why << std::endl;
  return result == code(ExitCode::done) ? code(ExitCode::bad_input) : result;
}

}  // namespace

int guarded(const std::function<int()>& work) {
  const auto fail = [](const char* what, ExitCode exit_code) {
    if (interrupted()) return kInterrupted;
    // All ranks have the same command line: one of them says what is wrong with it. Launchers end all ranks when one
    // has ended, so that one is given time.
    if (exit_code != ExitCode::machine_failure && ranks::launched_ranks().own != 0) {
      std::this_thread::sleep_for(std::chrono::seconds(1));
      return code(exit_code);
    }
    std::cerr << "torolux: " << what << std::endl;
    return code(exit_code);
  };
  try {
    const int result = work();
    return interrupted() ? kInterrupted : result;
  } catch (const Interrupted&) {
    return kInterrupted;
  } catch (const UsageError& error) {
    return fail((std::string(error.what()) + " (see --help)").c_str(), ExitCode::usage);
  } catch (const InputError& error) {
    return fail(error.what(), ExitCode::bad_input);
  } catch (const std::bad_alloc&) {
    return fail("this computer has too little memory for that", ExitCode::machine_failure);
  } catch (const std::exception& error) {
    return fail(error.what(), ExitCode::machine_failure);
  }
}

void add_commands(CLI::App& app, CommandAction& action) {
  add_render_command(app, action);
  add_info_command(app, action);
  add_inspect_command(app, action);
  add_compare_command(app, action);
  add_tonemap_command(app, action);
  add_run_command(app, action);
  add_profile_command(app, action);
  add_network_command(app, action);
  add_lockstep_command(app, action);
  add_bench_command(app, action);
  add_rerun_command(app, action);
  add_study_command(app, action);
  add_manual_command(app, action);
  add_cc_command(app, action);
}

int torolux_main(int argc, const char* const* argv) {
  // A rank hears of one signal from its sender, its keeper, and its starter, which kills it at the user's second.
  const InterruptionGuard guard(ranks::join_starter() ? SecondSignal::nothing : SecondSignal::ends);
  set_interruption(&interrupted);
  CLI::App app("Torolux: a massively parallel machine for image synthesis, emulated", "torolux");
  app.set_version_flag("--version", version_text());
  app.require_subcommand(1);
  app.formatter(std::make_shared<HelpFormat>());
  app.footer(
      "Exit codes: 0 done, 1 usage, 2 bad input, 3 machine failure, 130 interrupted.\n"
      "`torolux COMMAND --help` tells the options of a command.");
  CommandAction action;
  add_commands(app, action);
  std::cout.clear();
  const int result = flushed(guarded([&] { return run(app, action, argc, argv); }));
  if (result == kInterrupted && !ranks::has_starter()) std::cerr << "torolux: interrupted" << std::endl;
  ranks::tell_starter(result);
  return result;
}

}  // namespace torolux
