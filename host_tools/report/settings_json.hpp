// SPDX-License-Identifier: MIT
// Everything that determines a run, as resolved, as a block of the statistics; and the command line that repeats it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "emulator/machine/machine.hpp"
#include "host_tools/report/figures.hpp"
#include "host_tools/report/run_images.hpp"

namespace torolux {

/// Rises when a key of the statistics goes or changes its meaning.
inline constexpr unsigned kStatisticsVersion = 2;

/// The `settings` of `torolux render`. figures: absent before the run; then `pe_memory` and `subspaces` are absent
/// where they are left to the program.
nlohmann::ordered_json settings_json(const RunDescription& run, const RenderFigures* figures);

/// Files of `torolux run` that bear on it: images, and what programs may read; and the names by which they may write
/// others.
struct ProgramFiles {
  RunImages images;
  std::vector<InputFile> read;
  std::vector<std::string> outputs;
};
/// Those of `torolux run`.
nlohmann::ordered_json settings_json(const MachineSetup& setup, const ProgramFiles& inputs);

/// `settings` without what cannot change cycles or bytes: versions, names and paths (inputs stay as digests), and what
/// a run chooses by itself from the rest. Equal for equal runs, before and after.
nlohmann::ordered_json determining(nlohmann::ordered_json settings);

/// The words after `torolux` that lead to these settings again; options of results and --threads are not among them.
/// Throws InputError where the block is not whole.
std::vector<std::string> command_line_of(const nlohmann::ordered_json& settings);

}  // namespace torolux
