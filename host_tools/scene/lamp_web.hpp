// SPDX-License-Identifier: MIT
// A web of measured intensities enters; the intensity in a direction, and the flux of each half, leave.
#pragma once

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Between the web's angles bilinear in both, as LM-63 has it [W/sr]. gamma: degrees, 0..180; turn: degrees, any.
double intensity_of(const LampWeb& web, double gamma, double turn);

/// Below and above the horizon [W]: exact integrals of the above.
std::array<double, 2> flux_of(const LampWeb& web);

}  // namespace torolux
