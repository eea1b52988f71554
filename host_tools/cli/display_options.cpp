// SPDX-License-Identifier: MIT
// Words into an address; a browser is started where that is asked for.
#include "host_tools/cli/display_options.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <iostream>
#include <vector>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/interruption.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/table_options.hpp"

namespace torolux {
namespace {

constexpr std::uint64_t kMostPort = 65535;

int parse_port(const std::string& text) {
  try {
    return static_cast<int>(parse_count(text, 0, kMostPort));
  } catch (const UsageError&) {
    throw UsageError("\"" + text + "\" is not a port (0 to 65535); what else follows stands before --display");
  }
}

/// The program goes its own way; what it says is its own business.
void start_browser(const std::string& url) {
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    posix_spawn_file_actions_addopen(&actions, stream, "/dev/null", O_RDWR, 0);
  std::string name = "xdg-open", address = url;
  const std::array<char*, 3> words{name.data(), address.data(), nullptr};
  pid_t child = 0;
  const int error = ::posix_spawnp(&child, name.c_str(), &actions, nullptr, words.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) std::cerr << "torolux: note: no browser could be started (xdg-open); open " << url << "\n";
}

}  // namespace

void add_display_options(CLI::App& command, DisplayOptions& options, const std::string& group) {
  const auto in_group = [&group](CLI::Option* option) {
    if (!group.empty()) option->group(group);
  };
  const auto take = [&options](const std::vector<std::string>& words) {
    options.display = true;
    if (!words.empty() && !words.back().empty()) options.port = value_of("--display", parse_port, words.back());
  };
  in_group(command
               .add_option_function<std::vector<std::string>>(
                   "--display", take,
                   "Show the run while it goes on, in a browser at this port of this computer; 0: any free one "
                   "(docs/display.md) [8080]")
               ->type_name("[PORT]")
               ->expected(0, 1)
               ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast));
  in_group(add_value(command, "--display-address", "ADDR",
                     "Of the display: serve at this address of this computer; another than its own demands the token "
                     "that is printed [127.0.0.1]",
                     [&options](const std::string& text) {
                       if (text.empty()) throw UsageError("the address is empty");
                       options.address = text;
                     }));
  in_group(command.add_flag("--open", options.open, "Of the display: open it in a browser (xdg-open)"));
  in_group(command.add_flag("--paused", options.paused, "Of the display: the run stands until the page lets it go"));
}

std::unique_ptr<Display> open_display(const DisplayOptions& options, const DisplayedRun& run) {
  if (!options.display) {
    if (options.address || options.open || options.paused) {
      throw UsageError("--display-address, --open and --paused say how a run is displayed; --display asks for that");
    }
    return nullptr;
  }
  DisplayAddress where;
  if (options.port) where.port = *options.port;
  if (options.address) where.address = *options.address;
  auto display = std::make_unique<Display>(where, run);
  if (options.paused) display->pace().stand();
  std::cerr << "torolux: display: " << display->url() << std::endl;
  if (options.open) start_browser(display->url());
  return display;
}

void keep_display(bool quiet, const std::function<void(const std::function<bool()>&)>& keep) {
  if (!quiet) std::cerr << "torolux: the display stays until Ctrl-C, or End in its page" << std::endl;
  keep([] { return interrupted(); });
  forget_interruption();  // all results are there
}

}  // namespace torolux
