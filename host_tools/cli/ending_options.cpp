// SPDX-License-Identifier: MIT
// Words into cycles, seconds and places.
#include "host_tools/cli/ending_options.hpp"

#include <CLI/CLI.hpp>

#include "emulator/errors.hpp"
#include "host_tools/cli/parse_values.hpp"
#include "host_tools/cli/table_options.hpp"
#include "host_tools/files/write_file.hpp"

namespace torolux {
namespace {

constexpr std::uint64_t kMostCycles = std::uint64_t{1} << 60U;
constexpr std::uint64_t kMostSeconds = 100'000'000;

}  // namespace

void add_ending_options(CLI::App& command, EndingOptions& options) {
  add_value(command, "--until", "CYCLE",
            "End the run at this virtual time, if it has not ended before: nothing at it or later happens [to the end]",
            [&options](const std::string& text) { options.until = parse_count(text, 1, kMostCycles); });
  add_value(command, "--timeout", "SECONDS",
            "Give the run up after so much wall time (exit code 3), and tell where each PE stands [none]",
            [&options](const std::string& text) {
              options.timeout = static_cast<unsigned>(parse_count(text, 1, kMostSeconds));
            });
  add_values(command, "--dump", "PE:PLACE[:BYTES]=FILE",
             "At the end of the run, failed or not, local memory of this PE: from an address, or from a symbol of its "
             "image (without BYTES: as long as that is). May be repeated",
             "", [&options](const std::string& text) { options.dumps.push_back(parse_dump(text)); });
}

std::vector<MemoryDump> checked_dumps(const EndingOptions& options, const MachineSetup& setup, const ImageSet& images) {
  std::vector<MemoryDump> dumps;
  for (const DumpRequest& request : options.dumps) {
    dumps.push_back(resolve_dump(request, setup, images));
    check_file_writable(request.file);
  }
  return dumps;
}

std::vector<NamedFile> files_of(const std::vector<DumpRequest>& dumps) {
  std::vector<NamedFile> files;
  files.reserve(dumps.size());
  for (const DumpRequest& dump : dumps) files.push_back({"--dump", dump.file});
  return files;
}

Timeout::Timeout(std::optional<unsigned> seconds) : seconds_(seconds) {}

bool Timeout::is_over() const {
  return seconds_ && std::chrono::steady_clock::now() - begin_ >= std::chrono::seconds(*seconds_);
}

std::string Timeout::while_held() const {
  if (!is_over()) return "";
  return "the run has taken " + std::to_string(*seconds_) +
         " s, and is given up (--timeout) while its PEs are held for a debugger (--gdb)";
}

void Timeout::check(const Machine& machine, Cycles now) const {
  if (!is_over()) return;
  throw MachineFailure("at cycle " + std::to_string(now) + " the run has taken " + std::to_string(*seconds_) +
                       " s, and is given up (--timeout)" + machine.where_pes_stand());
}

}  // namespace torolux
