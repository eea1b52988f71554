// SPDX-License-Identifier: MIT
// Options into Debugging; a port into a command to type.
#include "host_tools/cli/debugging_options.hpp"

#include <CLI/CLI.hpp>
#include <iostream>

#include "firmware/protocol/machine.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/table_options.hpp"

namespace torolux {
namespace {

/// In single quotes for a shell, where it needs them.
std::string shell_word(const std::string& text) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789/._-+,=:@%";
  if (text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

}  // namespace

void add_debugging_options(CLI::App& command, Debugging& debugging, const std::string& group) {
  add_values(command, "--qemu-pes", "LIST",
             "PEs that run on QEMU whatever runs the rest: numbers and ranges, like 0-3,7. May be repeated", group,
             [&debugging](const std::string& text) {
               const std::vector<unsigned> pes = parse_pe_list(text);
               debugging.qemu_pes.insert(debugging.qemu_pes.end(), pes.begin(), pes.end());
             });
  add_values(command, "--gdb", "PE:PORT|PE:PATH",
             "Halt this PE at its start, on QEMU, until a debugger that connects to this port of 127.0.0.1 lets it go "
             "on; 0: any free port; a path with a slash: a socket there that this user alone may open. May be repeated",
             group, [&debugging](const std::string& text) { debugging.gdb.push_back(parse_gdb_endpoint(text)); });
}

std::function<void(const GdbEndpoint&)> announce_debugger(
    std::function<std::filesystem::path(unsigned pe)> image_of_pe) {
  return [image_of_pe = std::move(image_of_pe)](const GdbEndpoint& debugger) {
    const std::string file = shell_word(image_of_pe(debugger.pe).string());
    const std::string place = debugger.path.empty() ? "127.0.0.1:" + std::to_string(debugger.port)
                                                    : std::filesystem::absolute(debugger.path).string();
    std::cerr << "torolux: PE " << debugger.pe << " is halted until a debugger lets it go on:\n"
              << "  gdb-multiarch " << file << " -ex " << shell_word("target remote " + place) << " -ex 'tbreak *"
              << std::hex << std::showbase << protocol::kLocalMemoryBase << std::dec << "' -ex continue" << std::endl;
  };
}

}  // namespace torolux
