// SPDX-License-Identifier: MIT
// A scene enters; which emitters are too small for single precision leaves.
#pragma once

#include <string>
#include <vector>

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// One sentence for each material that emits from a surface of less than 1/200,000 of the scene, or from a body of less
/// than 1/100,000, with the smallest of them.
std::vector<std::string> small_emitters(const Scene& scene);

}  // namespace torolux
