// SPDX-License-Identifier: MIT
// The light that falls on the surfaces of whole scenes, by material: the radiosity stage against the path tracer. Where
// this is right and the picture is not, the elements or their interpolation are to blame.
#pragma once

#include "tests/accuracy/picture_report.hpp"

namespace torolux::accuracy {

/// Writes surfaces.csv and surfaces.md.
void report_surfaces(const ReportChoice& choice);

}  // namespace torolux::accuracy
