// SPDX-License-Identifier: MIT
// Words that the parser refused enter; what was wrong with them leaves, with what was probably meant.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
class ParseError;
}  // namespace CLI

namespace torolux {

/// What is wrong where the words name no command; "" where they do, or none is needed.
std::string unknown_command(const CLI::App& app, const std::vector<std::string>& words);

/// words: as typed, without the program's name; app: as it was when it refused them.
std::string parse_error_text(const CLI::App& app, const std::vector<std::string>& words, const CLI::ParseError& error);

}  // namespace torolux
