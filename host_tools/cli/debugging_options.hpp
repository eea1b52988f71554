// SPDX-License-Identifier: MIT
// --qemu-pes and --gdb: which PEs run on QEMU and which a debugger may hold; and what to tell whoever wants to connect.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "emulator/engines/engine/debugging.hpp"

namespace CLI {
class App;
}

namespace torolux {

void add_debugging_options(CLI::App& command, Debugging& debugging, const std::string& group);

/// As Debugging::listens: prints on standard error how to connect. image_of_pe: the file that a PE runs.
std::function<void(const GdbEndpoint&)> announce_debugger(
    std::function<std::filesystem::path(unsigned pe)> image_of_pe);

}  // namespace torolux
