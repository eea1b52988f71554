// SPDX-License-Identifier: MIT
// Commands and options enter, scripts leave.
#include "host_tools/manual/completions.hpp"

#include <algorithm>

namespace torolux {
namespace {

std::string joined(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : " ") + word;
  return text;
}

/// Commands directly below `command`: their last words.
std::vector<std::string> commands_below(const std::vector<CommandEntry>& commands, const CommandEntry& command) {
  std::vector<std::string> names;
  const std::string before = command.words.empty() ? "" : command.words + " ";
  for (const CommandEntry& other : commands) {
    if (other.words.empty() || !other.words.starts_with(before)) continue;
    const std::string rest = other.words.substr(before.size());
    if (rest.find(' ') == std::string::npos) names.push_back(rest);
  }
  return names;
}

std::vector<std::string> option_names(const CommandEntry& command) {
  std::vector<std::string> names;
  for (const CommandOption& option : command.options)
    if (!option.positional) names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

bool takes_scene(const CommandEntry& command) {
  return std::any_of(command.options.begin(), command.options.end(), [](const CommandOption& option) {
    return option.positional && option.names.back().find("SCENE") != std::string::npos;
  });
}

/// In single quotes, for bash, zsh and fish alike.
std::string shell_word(const std::string& text) {
  std::string out = "'";
  for (const char c : text) out += c == '\'' ? std::string("'\"'\"'") : std::string(1, c);
  return out + "'";
}

/// In an argument of zsh's _arguments: colons and brackets mean something there.
std::string zsh_plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == ':' || c == '[' || c == ']' || c == '\\') out += '\\';
    out += c;
  }
  return out;
}

std::string zsh_option(const CommandOption& option) {
  std::string value;
  if (option.value != ValueOf::nothing) {
    value = ":" + zsh_plain(option.form) + ":";
    if (option.value == ValueOf::words) value += "(" + joined(option.words) + ")";
    if (option.value == ValueOf::file) value += "_files";
    if (option.value == ValueOf::folder) value += "_files -/";
  }
  std::string text;
  for (const std::string& name : option.names)
    text += "        " + shell_word("*" + name + "[" + zsh_plain(option.help) + "]" + value) + " \\\n";
  return text;
}

std::string bash_case(const std::vector<CommandEntry>& commands, const CommandEntry& command,
                      const std::vector<std::string>& scenes) {
  std::string text = "    " + shell_word(command.words) + ")\n      case $previous in\n";
  for (const CommandOption& option : command.options) {
    if (option.positional || option.value == ValueOf::nothing) continue;
    text += "        " + option.names.back() + ") ";
    if (option.value == ValueOf::words) text += "words=" + shell_word(joined(option.words));
    if (option.value == ValueOf::file) text += "files=-f";
    if (option.value == ValueOf::folder) text += "files=-d";
    if (option.value == ValueOf::other) text += "words=";
    text += " ;;\n";
  }
  std::vector<std::string> others = commands_below(commands, command);
  if (takes_scene(command)) others.insert(others.end(), scenes.begin(), scenes.end());
  text += "        *)\n          if [[ $word == -* ]]; then words=" + shell_word(joined(option_names(command))) +
          "\n          else words=" + shell_word(joined(others)) + (command.has_commands ? "" : " files=-f") +
          "\n          fi ;;\n";
  return text + "      esac ;;\n";
}

}  // namespace

std::string bash_completions(const std::vector<CommandEntry>& commands, const std::vector<std::string>& scenes) {
  std::string known;
  for (const CommandEntry& command : commands) known += "|" + command.words;
  std::string text =
      "# bash completion of torolux; written by the program itself\n_torolux() {\n"
      "  local word=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command= words= files= i\n"
      "  for ((i = 1; i < COMP_CWORD; ++i)); do\n"
      "    case '" +
      known +
      "|' in *\"|${command:+$command }${COMP_WORDS[i]}|\"*)\n"
      "      command+=${command:+ }${COMP_WORDS[i]} ;;\n    esac\n  done\n  case $command in\n";
  for (const CommandEntry& command : commands) text += bash_case(commands, command, scenes);
  return text +
         "  esac\n  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "  if [[ -n $files ]]; then\n    compopt -o filenames 2>/dev/null\n"
         "    local IFS=$'\\n'\n    COMPREPLY+=($(compgen \"$files\" -- \"$word\"))\n  fi\n"
         "}\ncomplete -F _torolux torolux\n";
}

std::string zsh_completions(const std::vector<CommandEntry>& commands, const std::vector<std::string>& scenes) {
  std::string known;
  for (const CommandEntry& command : commands) known += " " + shell_word(command.words);
  std::string text =
      "#compdef torolux\n# zsh completion of torolux; written by the program itself\n_torolux() {\n"
      "  local command= word i=2\n  local -a known=(" +
      known +
      ")\n"
      "  for word in ${words[2,CURRENT-1]}; do\n"
      "    (( ${known[(Ie)${command:+$command }$word]} )) || continue\n"
      "    command+=${command:+ }$word\n  done\n  case $command in\n";
  for (const CommandEntry& command : commands) {
    text += "    (" + shell_word(command.words) + ")\n      _arguments -S \\\n";
    for (const CommandOption& option : command.options)
      if (!option.positional) text += zsh_option(option);
    const std::vector<std::string> below = commands_below(commands, command);
    std::string rest = "_files";
    if (takes_scene(command)) rest = "{_files; compadd -- " + joined(scenes) + "}";
    if (!below.empty()) rest = "(" + joined(below) + ")";
    text += "        " + shell_word("*:argument:" + rest) + " ;;\n";
  }
  return text + "  esac\n}\n_torolux \"$@\"\n";
}

std::string fish_completions(const std::vector<CommandEntry>& commands, const std::vector<std::string>& scenes) {
  std::string text = "# fish completion of torolux; written by the program itself\n";
  for (const CommandEntry& command : commands) {
    const std::vector<std::string> below = commands_below(commands, command);
    std::string when;
    for (std::size_t at = 0; at < command.words.size();) {
      const std::size_t end = std::min(command.words.find(' ', at), command.words.size());
      when += (when.empty() ? "" : "; and ") + ("__fish_seen_subcommand_from " + command.words.substr(at, end - at));
      at = end + 1;
    }
    if (when.empty()) when = "__fish_use_subcommand";
    if (!command.words.empty() && !below.empty()) when += "; and not __fish_seen_subcommand_from " + joined(below);
    const std::string head = "complete -c torolux -n " + shell_word(when);
    for (const std::string& name : below) {
      const std::string words = command.words.empty() ? name : command.words + " " + name;
      const auto other = std::find_if(commands.begin(), commands.end(),
                                      [&words](const CommandEntry& entry) { return entry.words == words; });
      text += head + " -f -a " + name + " -d " + shell_word(other->help) + "\n";
    }
    if (takes_scene(command)) text += head + " -a " + shell_word(joined(scenes)) + "\n";
    for (const CommandOption& option : command.options) {
      if (option.positional) continue;
      text += head;
      for (const std::string& name : option.names)
        text += name.starts_with("--") ? " -l " + name.substr(2) : " -s " + name.substr(1);
      if (option.value == ValueOf::words) text += " -x -a " + shell_word(joined(option.words));
      if (option.value == ValueOf::file) text += " -r -F";
      if (option.value == ValueOf::folder) text += " -x -a '(__fish_complete_directories)'";
      if (option.value == ValueOf::other) text += " -x";
      text += " -d " + shell_word(option.help) + "\n";
    }
  }
  return text;
}

}  // namespace torolux
