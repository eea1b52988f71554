// SPDX-License-Identifier: MIT
// --qemu-pes, --gdb and --gdb-pes: which PEs run on QEMU and which a debugger may hold; and what to tell whoever wants
// to connect.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "emulator/debugger/session.hpp"
#include "emulator/engines/engine/debugging.hpp"

namespace CLI {
class App;
}

namespace torolux {

void add_debugging_options(CLI::App& command, Debugging& debugging, const std::string& group);

/// The emulator's own debugger, if that is asked for, which then is in `debugging`; null: it does not. Prints on
/// standard error how to connect. image_of_pe: the file that a PE runs. goes_back, gives_up: as SessionOptions. Throws
/// UsageError, InputError.
std::unique_ptr<debugger::Session> open_debugger(Debugging& debugging, unsigned columns, unsigned rows,
                                                 const std::function<std::filesystem::path(unsigned pe)>& image_of_pe,
                                                 bool goes_back, std::function<std::string()> gives_up = {});

/// As Debugging::listens: prints on standard error how to connect. image_of_pe: the file that a PE runs.
std::function<void(const GdbEndpoint&)> announce_debugger(
    std::function<std::filesystem::path(unsigned pe)> image_of_pe);

}  // namespace torolux
