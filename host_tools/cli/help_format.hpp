// SPDX-License-Identifier: MIT
// How --help looks: two columns, the second one wrapped.
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace torolux {

class HelpFormat : public CLI::Formatter {
 public:
  HelpFormat() { column_width(26); }
  /// Name and form only.
  std::string make_option_opts(const CLI::Option* option) const override;
  /// What an option is when it is not given stands behind its description, in brackets.
  std::string make_option(const CLI::Option* option, bool is_positional) const override;
  std::string make_subcommand(const CLI::App* command) const override;
  std::string make_group(std::string group, bool is_positional, std::vector<const CLI::Option*> options) const override;
};

}  // namespace torolux
