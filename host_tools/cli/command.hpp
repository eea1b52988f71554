// SPDX-License-Identifier: MIT
// How a subcommand joins the command line: it adds itself to the parser and leaves behind what is to be run.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace torolux {

/// What the command line asked for. Set by the subcommand that was parsed; returns an exit code (see ExitCode), or
/// throws UsageError, InputError or MachineFailure, which torolux_main turns into a message and an exit code.
using CommandAction = std::function<int()>;

/// Each adds one subcommand to `app`, whose callback sets `action`. Nothing else is done while parsing. Options are
/// kept by the callback, so `app` must outlive the action.
void add_render_command(CLI::App& app, CommandAction& action);
void add_info_command(CLI::App& app, CommandAction& action);
void add_inspect_command(CLI::App& app, CommandAction& action);
void add_compare_command(CLI::App& app, CommandAction& action);
void add_tonemap_command(CLI::App& app, CommandAction& action);
void add_run_command(CLI::App& app, CommandAction& action);
void add_profile_command(CLI::App& app, CommandAction& action);
void add_network_command(CLI::App& app, CommandAction& action);
void add_lockstep_command(CLI::App& app, CommandAction& action);
void add_bench_command(CLI::App& app, CommandAction& action);
void add_rerun_command(CLI::App& app, CommandAction& action);
void add_study_command(CLI::App& app, CommandAction& action);
void add_manual_command(CLI::App& app, CommandAction& action);
void add_cc_command(CLI::App& app, CommandAction& action);

/// All of them.
void add_commands(CLI::App& app, CommandAction& action);

/// `torolux cc`: words: what follows `cc`, which is a compiler's command line and not for the parser of the others.
/// Returns an exit code, or throws as a CommandAction; absent: the help of the command was asked for.
std::optional<int> run_cc_command(const std::vector<std::string>& words);

/// True after SIGINT or SIGTERM. Long work asks for it in its progress callback, cleans up and ends; torolux_main then
/// returns kInterrupted, whatever the action returned or threw.
bool interrupted();
inline constexpr int kInterrupted = 130;

/// Runs `work`; what it throws becomes a message and an exit code.
int guarded(const std::function<int()>& work);

/// The whole of the `torolux` executable. Exit codes: 0 done, 1 usage, 2 bad input, 3 machine failure, 130 interrupted.
int torolux_main(int argc, const char* const* argv);

}  // namespace torolux
