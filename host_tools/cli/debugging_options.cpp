// SPDX-License-Identifier: MIT
// Options into Debugging; a port into a command to type.
#include "host_tools/cli/debugging_options.hpp"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <iostream>
#include <utility>
#include <vector>

#include "emulator/errors.hpp"
#include "firmware/protocol/machine.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/table_options.hpp"
#include "host_tools/files/shell_line.hpp"

namespace torolux {
namespace {

void append(std::vector<unsigned>& pes, const std::vector<unsigned>& more) {
  pes.insert(pes.end(), more.begin(), more.end());
}

/// A port or path alone is the emulator's own debugger's.
void take_gdb(Debugging& debugging, const std::string& text) {
  const std::size_t colon = text.find(':');
  const bool names_pe = colon != std::string::npos && text.find('/') > colon;
  if (names_pe) return debugging.gdb.push_back(parse_gdb_endpoint(text));
  if (debugging.own) throw UsageError("given twice: one debugger holds all PEs; or name a PE, like 3:1234");
  debugging.own = parse_gdb_place(text);
}

/// Ascending, each once.
std::vector<unsigned> pes_to_hold(const Debugging& debugging, unsigned pes) {
  std::vector<unsigned> held = debugging.own_pes;
  if (held.empty()) {
    const std::vector<bool> on_qemu = debugging.on_qemu(pes);
    for (unsigned pe = 0; pe < pes; ++pe) {
      if (!on_qemu[pe]) held.push_back(pe);
    }
    if (held.empty()) throw UsageError("--gdb: no PE is left for the emulator's own debugger: all run on QEMU");
  }
  std::ranges::sort(held);
  held.erase(std::unique(held.begin(), held.end()), held.end());
  if (held.back() >= pes) {
    throw InputError("--gdb-pes: there is no PE " + std::to_string(held.back()) + "; the machine has 0 to " +
                     std::to_string(pes - 1));
  }
  return held;
}

std::string place_text(const GdbEndpoint& place) {
  return place.path.empty() ? "127.0.0.1:" + std::to_string(place.port)
                            : std::filesystem::absolute(place.path).string();
}

void announce(const debugger::Session& session, const std::filesystem::path& image) {
  std::cerr << "torolux: the PEs are held until a debugger lets them go on:\n  gdb-multiarch "
            << shell_line({image.string()}) << " -ex " << shell_line({"target remote " + place_text(session.place())})
            << " -ex 'set schedule-multiple on'" << std::endl;
}

}  // namespace

void add_debugging_options(CLI::App& command, Debugging& debugging, const std::string& group) {
  add_values(command, "--qemu-pes", "LIST",
             "PEs that run on QEMU whatever runs the rest: numbers and ranges, like 0-3,7. May be repeated", group,
             [&debugging](const std::string& text) { append(debugging.qemu_pes, parse_pe_list(text)); });
  add_values(command, "--gdb", "PORT|PATH|PE:PORT|PE:PATH",
             "Hold the PEs until a debugger that connects to this port of 127.0.0.1 lets them go on; 0: any free port; "
             "a path with a slash: a socket there that this user alone may open. With a PE: this one alone, on QEMU, "
             "by QEMU's own debugger; may be repeated",
             group, [&debugging](const std::string& text) { take_gdb(debugging, text); });
  add_values(command, "--gdb-pes", "LIST",
             "PEs that the debugger of --gdb PORT holds: numbers and ranges, like 0-3,7. May be repeated [all]", group,
             [&debugging](const std::string& text) { append(debugging.own_pes, parse_pe_list(text)); });
}

std::unique_ptr<debugger::Session> open_debugger(Debugging& debugging, unsigned columns, unsigned rows,
                                                 const std::function<std::filesystem::path(unsigned pe)>& image_of_pe,
                                                 bool goes_back, std::function<std::string()> gives_up) {
  if (!debugging.own) {
    if (!debugging.own_pes.empty()) throw UsageError("--gdb-pes names PEs for --gdb PORT, which is not there");
    return nullptr;
  }
  debugger::SessionOptions options;
  options.place = *debugging.own;
  options.columns = columns;
  options.image_of_pe = image_of_pe;
  options.pes = pes_to_hold(debugging, columns * rows);
  options.goes_back = goes_back;
  options.goes_on = [] { return !interrupted(); };
  options.gives_up = std::move(gives_up);
  const unsigned first = options.pes.front();
  auto session = std::make_unique<debugger::Session>(std::move(options));
  debugging.debugger = session.get();
  announce(*session, image_of_pe(first));
  return session;
}

std::function<void(const GdbEndpoint&)> announce_debugger(
    std::function<std::filesystem::path(unsigned pe)> image_of_pe) {
  return [image_of_pe = std::move(image_of_pe)](const GdbEndpoint& debugger) {
    const std::string file = shell_line({image_of_pe(debugger.pe).string()});
    std::cerr << "torolux: PE " << debugger.pe << " is halted until a debugger lets it go on:\n"
              << "  gdb-multiarch " << file << " -ex " << shell_line({"target remote " + place_text(debugger)})
              << " -ex 'tbreak *" << std::hex << std::showbase << protocol::kLocalMemoryBase << std::dec
              << "' -ex continue" << std::endl;
  };
}

}  // namespace torolux
