// SPDX-License-Identifier: MIT
// What a program on the PEs gets from outside, and what becomes of what it says: --input, --output, --raw, arguments.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "host_tools/files/distinct_files.hpp"
#include "host_tools/run/pe_text.hpp"
#include "host_tools/run/served_files.hpp"

namespace CLI {
class App;
}

namespace torolux {

struct ProgramOptions {
  std::vector<GivenFile> inputs, outputs;
  std::vector<std::string> arguments;
  bool raw = false;
};

void add_program_options(CLI::App& command, ProgramOptions& options);

/// Throws UsageError where a name is given twice, InputError where an output cannot be written.
void check_files(const ProgramOptions& options);
/// For check_distinct: outputs, and inputs.
std::vector<NamedFile> written_files(const ProgramOptions& options);
std::vector<NamedFile> read_files(const ProgramOptions& options);

/// A line on standard output or standard error.
void print_text(const PeText& text, bool raw);

}  // namespace torolux
