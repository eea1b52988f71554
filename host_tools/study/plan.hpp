// SPDX-License-Identifier: MIT
// A study's plan enters as it stands in its file; leaves: what every run has, what varies, what is reported.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "host_tools/scene/files.hpp"

namespace torolux::study {

/// What stands behind `--`, for the program on the PEs.
inline constexpr const char* kArguments = "arguments";

/// One option of a command.
struct PlanOption {
  /// Long name without dashes ("max-shots"), "scene", "image", "machine.torus.flit_bytes", or kArguments.
  std::string name;
  std::string value;  ///< as on the command line; of a flag "true" or "false"; of kArguments words with blanks between
  bool flag = false;  ///< written as a boolean
  Place place;
};

/// One option with the values that it takes in turn.
struct Axis {
  std::string name;
  std::vector<PlanOption> values;
};

struct Report {
  std::string x;               ///< empty: chosen
  std::vector<std::string> y;  ///< empty: chosen
  std::string by;              ///< empty: one series
  std::string title;
  bool log_x = false, log_y = false;
  std::map<std::string, std::string> baseline;  ///< option -> value; empty: the first run
  std::map<std::string, std::size_t> lines;     ///< of the names in x, y and by, and of "baseline"
};

struct Plan {
  std::filesystem::path file;
  std::string command;
  unsigned threads = 1;  ///< of each run
  std::vector<PlanOption> base;
  std::vector<std::vector<PlanOption>> runs;  ///< [[run]]; none: one without options of its own
  std::vector<Axis> vary;
  std::vector<std::vector<std::string>> zip;  ///< names of `vary` that go together; each once at most
  std::vector<Axis> vary_one;
  Report report;
  std::size_t vary_line = 0;
};

/// Throws InputError with file and line: not TOML, unknown keys and options, lists of unequal lengths to zip, ...
/// Values are not looked at; a run refuses them.
Plan read_plan(const std::filesystem::path& file);
Plan parse_plan(std::string_view text, const std::filesystem::path& file);

}  // namespace torolux::study
