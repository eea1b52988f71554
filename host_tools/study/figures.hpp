// SPDX-License-Identifier: MIT
// A run's statistics and a name enter; one figure leaves: a value in them, or one that follows from them and from a run
// to compare with.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host_tools/study/results.hpp"

namespace torolux::study {

/// name: a dotted key of the statistics ("torus.hops.mean", "pes.0.busy_cycles"), or
///   pe_count         PEs
///   cycles           of all stages together; cycles.STAGE: of load, radiosity or ray_tracing alone
///   relative         cycles over those of the baseline; relative.STAGE
///   speed_up         the inverse; speed_up.STAGE
///   efficiency       speed_up times the baseline's PEs over the run's; efficiency.STAGE
///   balance          mean over greatest busy cycles of the PEs
///   utilisation      busy share of the PEs' time, mean
///   mean_hops, adjacent_share, memory (bytes of a PE)
/// baseline: absent where it has not run. Null where there is no such value.
Json figure(const Json& result, const Json* baseline, std::string_view name);

/// All names that `figure` knows besides keys of the statistics.
std::vector<std::string> derived_names();

/// What stands in every table of render and run.
std::vector<std::string> standard_names();

/// Exact: a number reads back as the same bits. Null: empty.
std::string cell_text(const Json& value);

}  // namespace torolux::study
