// SPDX-License-Identifier: MIT
// The radiosity stage's own result, before any picture: a case in, light of every element out.
#pragma once

#include <array>
#include <vector>

#include "host_tools/solution/solution.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {

struct SolvedScene {
  Scene scene;
  Mesh mesh;
  double watts_per_quantum;
  Solution solution;
  RenderFigures figures;

  /// What fell on an element [W], R G B. element: global number.
  std::array<double, 3> incident_flux(std::uint32_t element) const;
};

/// Renders the case and keeps its radiosities.
SolvedScene solve_scene(RenderCase render_case);
/// The same for a scene that is not in a file; the case's own is not looked at.
SolvedScene solve_scene(const Scene& scene, RenderCase render_case);

}  // namespace torolux::test
