// SPDX-License-Identifier: MIT
// --placing, and a command that mpirun has started as one of several: on rank 0 the command's own work with the others
// at hand; on these, PEs.
#pragma once

#include <functional>

#include "emulator/remote/pe_ranks.hpp"

namespace CLI {
class App;
}

namespace torolux {

struct RankOptions {
  remote::Placing placing = remote::Placing::block;
};

void add_rank_options(CLI::App& command, RankOptions& options, const std::string& group);

/// Calls `work` with the other ranks, null where there are none, and returns what it returns. On another rank than 0:
/// runs PEs until the work has ended; `work` is not called. Throws UsageError where this build cannot join them.
int run_on_ranks(const RankOptions& options, const std::function<int(remote::PeRanks*)>& work);

/// Throws UsageError where an option is given that does not go with other ranks. given: whether it is; option: its
/// name.
void refuse_on_ranks(bool given, const std::string& option);

}  // namespace torolux
