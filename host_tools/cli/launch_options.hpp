// SPDX-License-Identifier: MIT
// --ranks and --launcher: a command that starts itself as several ranks.
#pragma once

#include <optional>
#include <string>

#include "host_tools/launch/launch_words.hpp"

namespace CLI {
class App;
}

namespace torolux {

void add_launch_options(CLI::App& command, const std::string& group);

/// Of a command that was parsed; absent: it is to be done by this process, as a rank or alone. Throws UsageError:
/// mpirun has started this process as a rank already, or there is a launcher for nothing.
std::optional<launch::LaunchChoice> launch_asked(const CLI::App& command);

}  // namespace torolux
