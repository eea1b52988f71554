// SPDX-License-Identifier: MIT
// Options of the table (host_tools/settings/options.hpp) enter; a subcommand that has them leaves, and what is given
// lands in the settings.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "host_tools/cli/named_value.hpp"
#include "host_tools/settings/given_settings.hpp"

namespace torolux {

/// Adds an option whose text goes through `parse`; errors name the option. Given twice, the last one holds.
template <class Parse>
CLI::Option* add_value(CLI::App& command, const std::string& name, const std::string& form, const std::string& help,
                       Parse parse) {
  const auto take = [name, parse](const std::string& text) { value_of(name, parse, text); };
  return command.add_option_function<std::string>(name, take, help)
      ->type_name(form)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
}

/// The same for an option that may be repeated: each of its texts goes through `parse`. group: "": the general one.
template <class Parse>
void add_values(CLI::App& command, const std::string& name, const std::string& form, const std::string& help,
                const std::string& group, Parse parse) {
  const auto take = [name, parse](const std::vector<std::string>& texts) {
    for (const std::string& text : texts) value_of(name, parse, text);
  };
  CLI::Option* option = command.add_option_function<std::vector<std::string>>(name, take, help);
  option->type_name(form)->allow_extra_args(false);
  if (!group.empty()) option->group(group);
}

/// The group's heading in --help.
const char* heading(OptionGroup group);

/// Adds one option under its group's heading. `given` must outlive the command.
CLI::Option* add_table_option(CLI::App& command, const Option& option, GivenSettings& given);
/// Adds all of a group that have names.
void add_table_options(CLI::App& command, OptionGroup group, GivenSettings& given);

/// Throws UsageError unless `name` is an allocation; the message lists them all.
void check_allocation(const std::string& name);

}  // namespace torolux
