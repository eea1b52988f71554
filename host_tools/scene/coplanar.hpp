// SPDX-License-Identifier: MIT
// Surfaces of different materials that overlap in one plane: which of them a ray meets is decided by rounding.
#pragma once

#include <string>
#include <vector>

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Adds a sentence per pair of materials. Only planes across an axis, exactly equal coordinates, fronts alike or not.
void inspect_coplanar(const Scene& scene, std::vector<std::string>& found);

}  // namespace torolux
