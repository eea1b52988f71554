// SPDX-License-Identifier: MIT
// The parser keeps what was given: torolux_main asks for it before the command's own work.
#include "host_tools/cli/launch_options.hpp"

#include <CLI/CLI.hpp>

#include "emulator/errors.hpp"
#include "emulator/ranks/launched.hpp"

namespace torolux {
namespace {

constexpr const char* kRanks = "--ranks";
constexpr const char* kLauncher = "--launcher";
constexpr unsigned kMostRanks = 65536;

bool given(const CLI::Option* option) {
  return option != nullptr && option->count() > 0;
}

}  // namespace

void add_launch_options(CLI::App& command, const std::string& group) {
  CLI::Option* const ranks =
      command
          .add_option_function<unsigned>(
              kRanks, [](unsigned) {}, "Start so many processes by mpirun, watch them and end with their exit code [1]")
          ->type_name("N")
          ->check(CLI::Range(1U, kMostRanks));
  CLI::Option* const launcher = command
                                    .add_option_function<std::string>(
                                        kLauncher, [](const std::string&) {},
                                        "With --ranks: words of a launcher, to which -n N and this program are added: "
                                        "\"mpirun --hostfile hosts\" "
                                        "[mpirun of the MPI that this was built with]")
                                    ->type_name("WORDS");
  if (group.empty()) return;
  ranks->group(group);
  launcher->group(group);
}

std::optional<launch::LaunchChoice> launch_asked(const CLI::App& command) {
  const CLI::Option* const ranks = command.get_option_no_throw(kRanks);
  const CLI::Option* const launcher = command.get_option_no_throw(kLauncher);
  if (!given(ranks)) {
    if (given(launcher)) throw UsageError("--launcher: how many ranks it is to start says --ranks");
    return std::nullopt;
  }
  if (ranks::launched_ranks().count > 1)
    throw UsageError("--ranks starts ranks, and mpirun has done so: leave out one of them");
  launch::LaunchChoice choice{ranks->as<unsigned>(), given(launcher) ? launcher->as<std::string>() : ""};
  if (choice.ranks == 1) return std::nullopt;
  return choice;
}

}  // namespace torolux
