// SPDX-License-Identifier: MIT
// Walks through the parser.
#include "host_tools/manual/command_tree.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <sstream>
#include <variant>

#include "emulator/engines/engine_names.hpp"
#include "host_tools/settings/options.hpp"
#include "host_tools/settings/presets.hpp"

namespace torolux {
namespace {

/// The words of a form like refuse|white; empty: the form is another one.
std::vector<std::string> words_of_form(const std::string& form) {
  std::vector<std::string> words;
  if (form.find('|') == std::string::npos) return words;
  std::istringstream parts(form);
  for (std::string word; std::getline(parts, word, '|');) {
    if (word.find_first_not_of("abcdefghijklmnopqrstuvwxyz-") != std::string::npos) return {};
    words.push_back(word);
  }
  return words;
}

std::vector<std::string> words_of(const std::string& name, const std::string& form) {
  if (name == "--engine") {
    const auto names = engine_names();
    return {names.begin(), names.end()};
  }
  if (name == "--quality") {
    std::vector<std::string> words;
    words.reserve(kPresets.size());
    for (const Preset& preset : kPresets) words.emplace_back(preset.name);
    return words;
  }
  for (const Option& option : all_options()) {
    const auto* choice = std::get_if<option::Choice>(&option.kind);
    if (option.name == name && choice != nullptr) return {choice->names.begin(), choice->names.end()};
  }
  return words_of_form(form);
}

ValueOf value_of(const CommandOption& option) {
  if (!option.words.empty()) return ValueOf::words;
  if (option.positional || option.form.starts_with("FILE") || option.form == "PATH") return ValueOf::file;
  if (option.form == "FOLDER") return ValueOf::folder;
  return option.form.empty() ? ValueOf::nothing : ValueOf::other;
}

CommandOption option_of_parser(const CLI::Option& option) {
  CommandOption out;
  for (const std::string& name : option.get_snames()) out.names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) out.names.push_back("--" + name);
  out.positional = out.names.empty();
  if (out.positional) out.names.push_back(option.get_name(true));
  if (!out.positional && option.get_type_size() != 0) out.form = option.get_type_name();
  out.words = words_of(out.names.back(), out.form);
  out.value = value_of(out);
  out.group = option.get_group();
  const std::string& otherwise = option.get_default_str();
  out.help = option.get_description() + (otherwise.empty() ? "" : " [" + otherwise + "]");
  return out;
}

void add(const CLI::App& app, const std::string& words, std::vector<CommandEntry>& to) {
  const auto commands = app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
  CommandEntry entry{words, app.get_description(), {}, !commands.empty()};
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty()) entry.options.push_back(option_of_parser(*option));
  to.push_back(std::move(entry));
  for (const CLI::App* command : commands) add(*command, words + (words.empty() ? "" : " ") + command->get_name(), to);
}

}  // namespace

std::vector<CommandEntry> command_tree(const CLI::App& app) {
  std::vector<CommandEntry> entries;
  add(app, "", entries);
  return entries;
}

}  // namespace torolux
