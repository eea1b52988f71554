// SPDX-License-Identifier: MIT
// `torolux manual FOLDER`: the man page and the completions of this program, into that folder.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "host_tools/cli/command.hpp"
#include "host_tools/cli/own_scenes.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/manual/completions.hpp"
#include "host_tools/manual/manual_page.hpp"

namespace torolux {

void add_manual_command(CLI::App& app, CommandAction& action) {
  const auto folder = std::make_shared<std::filesystem::path>();
  CLI::App* command = app.add_subcommand("manual", "Write the man page and the shells' completions into a folder");
  command->add_option("FOLDER", *folder, "It must exist")->required()->type_name("");
  command->group("");  // for the build, not for users
  command->callback([folder, &app, &action] {
    action = [folder, &app] {
      const auto commands = command_tree(app);
      const auto scenes = own_scenes();
      write_file(*folder / "torolux.1", manual_page(commands, scenes));
      write_file(*folder / "torolux.bash", bash_completions(commands, scenes));
      write_file(*folder / "_torolux", zsh_completions(commands, scenes));
      write_file(*folder / "torolux.fish", fish_completions(commands, scenes));
      return 0;
    };
  });
}

}  // namespace torolux
