// SPDX-License-Identifier: MIT
// Words enter a parser; its complaints leave as UsageError.
#include "host_tools/cli/parse_words.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>

#include "emulator/errors.hpp"

namespace torolux {

void parse_words(CLI::App& command, std::vector<std::string> words) {
  std::ranges::reverse(words);  // as CLI11 takes them
  try {
    command.parse(std::move(words));
  } catch (const CLI::ParseError& error) {
    throw UsageError(error.what());
  }
}

}  // namespace torolux
