// SPDX-License-Identifier: MIT
// --checkpoint, --resume and what belongs to them: options enter; what is kept of a run leaves, and a checkpoint that
// is of this run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "host_tools/checkpoint/checkpoint_file.hpp"
#include "host_tools/checkpoint/keeper.hpp"
#include "host_tools/report/figures.hpp"

namespace CLI {
class App;
}

namespace torolux {

struct CheckpointOptions {
  std::optional<std::filesystem::path> file, resume;
  std::optional<std::uint64_t> rounds;
  std::optional<double> minutes;
};

/// --checkpoint, --checkpoint-rounds, --checkpoint-minutes, --resume.
void add_checkpoint_options(CLI::App& command, CheckpointOptions& options, const std::string& group);

/// Throws UsageError where it is said when, but not where to.
CheckpointChoice checkpoint_choice(const CheckpointOptions& options, const RunDescription& run);

/// Null: the run begins at its beginning. Throws InputError: no checkpoint, damaged, of another run or program.
std::unique_ptr<CheckpointReader> checkpoint_to_resume(const CheckpointOptions& options, const RunDescription& run);

}  // namespace torolux
