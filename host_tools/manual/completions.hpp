// SPDX-License-Identifier: MIT
// What shells offer when a command line is half typed.
#pragma once

#include <string>
#include <vector>

#include "host_tools/manual/command_tree.hpp"

namespace torolux {

/// Each a whole script, for the shell's folder of completions. After a command come its options, after an option the
/// words that it takes, or files; in place of a scene also the scenes that came with the program.
std::string bash_completions(const std::vector<CommandEntry>& commands, const std::vector<std::string>& scenes);
std::string zsh_completions(const std::vector<CommandEntry>& commands, const std::vector<std::string>& scenes);
std::string fish_completions(const std::vector<CommandEntry>& commands, const std::vector<std::string>& scenes);

}  // namespace torolux
