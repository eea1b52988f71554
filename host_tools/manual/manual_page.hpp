// SPDX-License-Identifier: MIT
// The man page.
#pragma once

#include <string>
#include <vector>

#include "host_tools/manual/command_tree.hpp"

namespace torolux {

/// torolux.1, for man. scenes: those that are installed.
std::string manual_page(const std::vector<CommandEntry>& commands, const std::vector<std::string>& scenes);

}  // namespace torolux
