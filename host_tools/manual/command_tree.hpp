// SPDX-License-Identifier: MIT
// The command line as plain values: CLI11's parser enters, commands with their options leave.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace torolux {

/// What a value of an option names.
enum class ValueOf : std::uint8_t { nothing, file, folder, words, other };

struct CommandOption {
  std::vector<std::string> names;  ///< with dashes; the last is the longest. A positional: its name alone
  bool positional = false;
  std::string form;  ///< of the value, like WxH; empty: a flag or a positional
  ValueOf value = ValueOf::nothing;
  std::vector<std::string> words;  ///< the values that there are, where they are words
  std::string group, help;         ///< help: with what holds where it is not given, in brackets
};

struct CommandEntry {
  std::string words;  ///< after the program's name: "render", "bench engine"; empty: the program itself
  std::string help;
  std::vector<CommandOption> options;
  bool has_commands = false;
};

/// The program, then every command that its help tells of, each before those inside it.
std::vector<CommandEntry> command_tree(const CLI::App& app);

}  // namespace torolux
