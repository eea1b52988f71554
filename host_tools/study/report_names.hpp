// SPDX-License-Identifier: MIT
// A plan enters; names in its [report] that no run of it can have are refused, before anything has run.
#pragma once

#include "host_tools/study/plan.hpp"

namespace torolux::study {

/// Throws InputError with file and line. What only an image or a scene decides (names of phases, kinds of records) is
/// left to whoever has results.
void check_report_names(const Plan& plan);

}  // namespace torolux::study
