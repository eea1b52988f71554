// SPDX-License-Identifier: MIT
// Looks for a command or an option that does not exist, then for words too many, in the order in which they were typed.
#include "host_tools/cli/parse_error.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <map>

#include "emulator/nearest_name.hpp"

namespace torolux {
namespace {

using Words = std::vector<std::string>;

/// The command that the words name, as far as they do, and how many they are.
struct Named {
  const CLI::App* command;
  std::size_t words = 0;
  std::string name;  ///< "bench engine"; empty: the program alone
};

Named named_command(const CLI::App& app, const Words& words) {
  Named named{&app, 0, ""};
  while (named.words < words.size()) {
    const std::vector<const CLI::App*> next =
        named.command->get_subcommands([&](const CLI::App* one) { return one->get_name() == words[named.words]; });
    if (next.empty()) break;
    named.name += (named.words == 0 ? "" : " ") + words[named.words];
    named.command = next[0];
    ++named.words;
  }
  return named;
}

Words command_names(const CLI::App& app) {
  Words names;
  for (const CLI::App* one : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(one->get_name());
  return names;
}

std::string of(const std::string& command) {
  return command.empty() ? "" : " of `torolux " + command + "`";
}

bool looks_like_option(const std::string& word) {
  return word.size() > 1 && word[0] == '-' && std::isdigit(static_cast<unsigned char>(word[1])) == 0 && word[1] != '.';
}

/// "" where every word that looks like an option is one.
std::string unknown_option(const Named& named, const Words& words) {
  Words known;
  for (const CLI::Option* option : named.command->get_options())
    for (const std::string& name : option->get_lnames()) known.push_back("--" + name);
  for (std::size_t i = named.words; i < words.size(); ++i) {
    const std::string name = words[i].substr(0, words[i].find('='));
    if (name == "--") break;
    if (!looks_like_option(name) || named.command->get_option_no_throw(name) != nullptr) continue;
    if (name == "-h" ||
        (i > named.words && named.command->get_option_no_throw(words[i - 1]) != nullptr && !name.starts_with("--")))
      continue;  // a value that begins with a dash
    return "there is no option '" + name + "'" + of(named.name) +
           did_you_mean(name.starts_with("--") ? name : "-" + name, known);
  }
  return "";
}

/// "" where no option that takes one value has several.
std::string given_again(const Named& named, const Words& words) {
  std::map<std::string, Words> values;
  for (std::size_t i = named.words; i < words.size() && words[i] != "--"; ++i) {
    const std::size_t equals = words[i].find('=');
    const std::string name = words[i].substr(0, equals);
    if (!name.starts_with("--")) continue;
    const CLI::Option* option = named.command->get_option_no_throw(name);
    if (option == nullptr || option->get_items_expected_max() != 1 ||
        option->get_multi_option_policy() != CLI::MultiOptionPolicy::Throw)
      continue;
    Words& given = values[name];
    if (equals != std::string::npos)
      given.push_back(words[i].substr(equals + 1));
    else if (i + 1 < words.size())
      given.push_back(words[++i]);
    if (given.size() > 1)
      return name + " is given twice, with " + given[0] + " and " + given[1] + "; it takes one value: leave one out";
  }
  return "";
}

}  // namespace

std::string unknown_command(const CLI::App& app, const Words& words) {
  const Named named = named_command(app, words);
  const Words commands = command_names(*named.command);
  if (named.words == words.size() || commands.empty() || looks_like_option(words[named.words])) return "";
  const std::string text = no_such_name(words[named.words], "no command" + of(named.name), commands);
  const auto later = std::ranges::find_if(
      words, [&](const std::string& word) { return std::ranges::find(commands, word) != commands.end(); });
  return later == words.end() ? text : text + ". The command comes first: torolux " + *later + " ...";
}

std::string parse_error_text(const CLI::App& app, const Words& words, const CLI::ParseError& error) {
  if (std::string text = unknown_command(app, words); !text.empty()) return text;
  const Named named = named_command(app, words);
  if (std::string text = unknown_option(named, words); !text.empty()) return text;
  if (dynamic_cast<const CLI::ArgumentMismatch*>(&error) != nullptr)
    if (std::string text = given_again(named, words); !text.empty()) return text;
  if (dynamic_cast<const CLI::ExtrasError*>(&error) == nullptr) return error.what();
  const Words left = named.command->remaining();
  for (std::size_t i = named.words; i < words.size(); ++i)
    if (std::ranges::find(left, words[i]) != left.end())
      return "'" + words[i] + "' is a word too many; `torolux " + named.name + " --help` tells what it takes";
  return error.what();
}

}  // namespace torolux
