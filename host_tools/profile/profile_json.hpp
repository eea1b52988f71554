// SPDX-License-Identifier: MIT
// A profile enters; JSON leaves: the table for programs, the call paths for the report's page.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "host_tools/profile/function_totals.hpp"
#include "host_tools/profile/paths.hpp"

namespace torolux {

/// The keys of docs/profile.md, one object, ended by a line end.
std::string profile_json(const ProfileTotals& totals, const ProfileNames& names, std::span<const unsigned> pes);

/// What host_tools/web/report/call_tree.js reads, without a line end. Paths with less than kLeastShownShare of all are
/// left out, with all that is below them.
inline constexpr double kLeastShownShare = 1e-5;
std::string flame_graph_json(const PathTree& tree, const ProfileNames& names, std::size_t pes);

}  // namespace torolux
