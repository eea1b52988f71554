// SPDX-License-Identifier: MIT
// Pictures of whole scenes against the path tracer.
#pragma once

#include "tests/accuracy/runs.hpp"

namespace torolux::accuracy {

/// Renders every scene at every setting; writes pictures.csv, pictures.md and, for each scene, its reference, the
/// product's pictures and their differences.
void report_pictures(const ReportChoice& choice);

}  // namespace torolux::accuracy
