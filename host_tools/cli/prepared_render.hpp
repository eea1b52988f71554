// SPDX-License-Identifier: MIT
// All that comes before a render's machine starts: options read, scene loaded, settings resolved, inputs' digests
// taken.
#pragma once

#include <string>
#include <vector>

#include "host_tools/cli/resolve.hpp"

namespace torolux {

struct PreparedRender {
  Scene scene;
  std::vector<std::string> findings;  ///< what in it looks as if it was not meant so
  Resolved resolved;
  RunDescription run;
};

/// Adds every option of `torolux render`.
void add_render_options(CLI::App& command, RenderOptions& options);

/// words: what stands after `torolux render`. Throws UsageError, InputError.
RenderOptions parse_render_options(const std::vector<std::string>& words);

/// Throws InputError: a scene that cannot be loaded or has no light, ...
PreparedRender prepare_render(const RenderOptions& options);

/// How a run has ended. statistics: empty where it was interrupted.
struct RunEnd {
  int exit_code = 0;
  std::string statistics;
};

/// Renders; writes and prints what the options ask for. Throws InputError (before the work where it can be known),
/// MachineFailure.
RunEnd run_prepared(PreparedRender& prepared, const RenderOptions& options);

}  // namespace torolux
