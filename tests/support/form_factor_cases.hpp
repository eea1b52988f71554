// SPDX-License-Identifier: MIT
// Pairs of black shapes whose form factor is known in closed form, as scenes: the first emits, the second absorbs, the
// rest escapes. So absorbed / emitted is the form factor.
#pragma once

#include <string>
#include <vector>

#include "host_tools/scene/scene.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {

struct FormFactorCase {
  std::string name;  ///< letters, digits and _
  double exact;
  Scene scene;
};

/// Parallel and perpendicular rectangles, discs, and a square so small that it is a point to the other.
std::vector<FormFactorCase> form_factor_cases();

/// As the radiosity stage has it, on the native engine; everything is shot. quality: patches, hemi-cube, points.
double measured_form_factor(const FormFactorCase& shapes, const Quality& quality);

}  // namespace torolux::test
