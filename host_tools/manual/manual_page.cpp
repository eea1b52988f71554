// SPDX-License-Identifier: MIT
// Commands and options enter, a page in the language of man leaves.
#include "host_tools/manual/manual_page.hpp"

#include <algorithm>

#include "host_tools/report/version.hpp"

namespace torolux {
namespace {

/// As text of troff: no command, dashes that can be copied.
std::string plain(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else
      out += c;
  }
  return out.starts_with('.') || out.starts_with('\'') ? "\\&" + out : out;
}

std::string bold(const std::string& text) {
  return "\\fB" + plain(text) + "\\fR";
}

std::string option_entry(const CommandOption& option) {
  std::string names;
  for (const std::string& name : option.names)
    names += (names.empty() ? "" : ", ") + (option.positional ? "\\fI" + plain(name) + "\\fR" : bold(name));
  const std::string form = option.form.empty() ? "" : " \\fI" + plain(option.form) + "\\fR";
  return ".TP\n" + names + form + "\n" + plain(option.help) + "\n";
}

std::string command_section(const CommandEntry& command) {
  std::string text = ".SS " + bold("torolux " + command.words) + "\n" + plain(command.help) + ".\n";
  std::vector<std::string> groups;
  for (const CommandOption& option : command.options) {
    const std::string group = option.positional ? "" : option.group;
    if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
  }
  for (const std::string& group : groups) {
    if (!group.empty() && group != "Options") text += ".PP\n" + plain(group) + ":\n";
    for (const CommandOption& option : command.options)
      if ((option.positional ? "" : option.group) == group) text += option_entry(option);
  }
  return text;
}

constexpr const char* kEnd =
    ".SH EXIT STATUS\n"
    ".TP\n0\nDone.\n.TP\n1\nUsage: the command line cannot be understood.\n"
    ".TP\n2\nBad input: a scene, a file or a value that is not allowed.\n"
    ".TP\n3\nThe machine has failed.\n.TP\n130\nInterrupted.\n"
    ".SH ENVIRONMENT\n"
    ".TP\n\\fBTOROLUX_FIRMWARE\\fR\npe.elf, or the folder that holds it, in place of the installed one.\n"
    ".TP\n\\fBXDG_CACHE_HOME\\fR, \\fBHOME\\fR\nWhere translated code is kept: torolux in the first, or .cache/torolux "
    "in the second.\n"
    ".SH FILES\nBelow the prefix, wherever it has been moved to:\n"
    ".TP\nshare/torolux/scenes\nScenes; their names suffice on the command line.\n"
    ".TP\nshare/torolux/firmware\nImages for the PEs.\n"
    ".TP\nshare/doc/torolux\nThe documents.\n";

}  // namespace

std::string manual_page(const std::vector<CommandEntry>& commands, const std::vector<std::string>& scenes) {
  std::string text = std::string(".TH TOROLUX 1 \"\" \"torolux ") + kVersion +
                     "\" \"User commands\"\n.SH NAME\ntorolux \\- a massively parallel machine for image synthesis, "
                     "emulated\n.SH SYNOPSIS\n";
  for (const CommandEntry& command : commands) {
    if (command.has_commands) continue;
    if (!text.ends_with("SYNOPSIS\n")) text += ".br\n";
    text += bold("torolux " + command.words) + " [\\fIoptions\\fR]";
    for (const CommandOption& option : command.options)
      if (option.positional) text += " \\fI" + plain(option.names.back()) + "\\fR";
    text += "\n";
  }
  text +=
      ".SH DESCRIPTION\nRenders scenes on an emulated torus of RISC\\-V processors, by radiosity and ray tracing, and "
      "tells what the machine took: cycles, load, traffic.\n.SH EXAMPLES\n.EX\ntorolux render cornell_box\n"
      "torolux render cornell_box \\-\\-quality draft \\-\\-output box.exr\ntorolux info interior\n.EE\n.PP\nScenes:";
  for (const std::string& scene : scenes) text += " " + plain(scene);
  text += "\n.SH COMMANDS\n";
  for (const CommandEntry& command : commands)
    if (!command.has_commands) text += command_section(command);
  return text + kEnd;
}

}  // namespace torolux
