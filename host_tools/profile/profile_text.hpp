// SPDX-License-Identifier: MIT
// A profile enters; a table for people leaves, and the same as lines for programs.
#pragma once

#include <cstddef>
#include <string>

#include "host_tools/profile/function_totals.hpp"
#include "host_tools/profile/paths.hpp"

namespace torolux {

/// most: functions shown, at least 1. pes: of how many PEs the totals are.
std::string profile_table(const ProfileTotals& totals, const ProfileNames& names, std::size_t pes, std::size_t most);

/// One row for each function, the header first, each line ended (docs/profile.md).
std::string profile_csv(const ProfileTotals& totals, const ProfileNames& names);

/// "outer;inner cycles" for each path that has cycles of its own: what flamegraph.pl and others read.
std::string folded_paths(const PathTree& tree, const ProfileNames& names);

}  // namespace torolux
