// SPDX-License-Identifier: MIT
// Options enter, the text of --help leaves.
#include "host_tools/cli/help_format.hpp"

#include <sstream>

namespace torolux {
namespace {

constexpr std::size_t kLineWidth = 100;

/// "  name", then the description, wrapped, from `column` on.
std::string entry(const std::string& name, const std::string& description, std::size_t column) {
  std::string line = "  " + name;
  if (line.size() + 2 > column)
    line += "\n" + std::string(column, ' ');
  else
    line.resize(column, ' ');
  std::istringstream words(description);
  std::string word;
  std::size_t used = column;
  bool first = true;
  while (words >> word) {
    if (!first && used + 1 + word.size() > kLineWidth) {
      line += "\n" + std::string(column, ' ');
      used = column;
      first = true;
    }
    line += (first ? "" : " ") + word;
    used += word.size() + (first ? 0 : 1);
    first = false;
  }
  return line + "\n";
}

}  // namespace

std::string HelpFormat::make_option_opts(const CLI::Option* option) const {
  const std::string form = option->get_type_name();
  return option->get_type_size() == 0 || form.empty() ? "" : " " + form;
}

std::string HelpFormat::make_option(const CLI::Option* option, bool is_positional) const {
  const std::string& otherwise = option->get_default_str();
  return entry(make_option_name(option, is_positional) + make_option_opts(option),
               option->get_description() + (otherwise.empty() ? "" : " [" + otherwise + "]"), get_column_width());
}

std::string HelpFormat::make_subcommand(const CLI::App* command) const {
  return entry(command->get_name(), command->get_description(), get_column_width());
}

std::string HelpFormat::make_group(std::string group, bool is_positional,
                                   std::vector<const CLI::Option*> options) const {
  std::string text = "\n" + group + ":\n";
  for (const CLI::Option* option : options) text += make_option(option, is_positional);
  return text;
}

}  // namespace torolux
