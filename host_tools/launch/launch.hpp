// SPDX-License-Identifier: MIT
// A command line with `--ranks` enters, the exit code of the whole run leaves.
#pragma once

#include <string>
#include <vector>

#include "host_tools/launch/launch_words.hpp"

namespace torolux::launch {

/// Starts this program as so many ranks, watches them, passes signals on to rank 0, and returns once none of them runs
/// any more. words: of the command line, without the program. Returns rank 0's exit code. Throws UsageError,
/// InputError: there is no launcher; MachineFailure: a rank was lost.
int run_ranks(const LaunchChoice& choice, const std::vector<std::string>& words);

}  // namespace torolux::launch
