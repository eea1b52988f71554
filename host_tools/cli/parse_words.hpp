// SPDX-License-Identifier: MIT
// Words of a command line that stands in a file enter; a command's options leave, as if the words had been typed.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace torolux {

/// Throws UsageError where `command` does not take these words; nothing is printed.
void parse_words(CLI::App& command, std::vector<std::string> words);

}  // namespace torolux
