// SPDX-License-Identifier: MIT
// The radiosity stage's solution of a small diffuse scene against the dense one with the same elements.
#pragma once

#include "tests/support/solve_scene.hpp"

namespace torolux::test {

struct DenseErrors {
  std::size_t elements;  ///< that any light reaches
  double rmse;           ///< of irradiance, by area, relative to the root mean square
  double worst;          ///< of any element and channel, relative to its own irradiance
  std::uint32_t worst_element;
};

/// visibility_rays: from each point of an element to each other; 0: nothing stands between elements.
DenseErrors dense_errors(const SolvedScene& solved, unsigned visibility_rays);

}  // namespace torolux::test
