// SPDX-License-Identifier: MIT
// What the radiosity stage transports, before any picture: form factors against closed forms, small rooms against the
// dense solution.
#pragma once

#include "tests/accuracy/runs.hpp"

namespace torolux::accuracy {

/// Writes form_factors.csv, form_factors.md.
void report_form_factors(const ReportChoice& choice);

/// Writes dense.csv, dense.md: the rooms of tests/data with the same elements in both.
void report_dense(const ReportChoice& choice);

}  // namespace torolux::accuracy
