// SPDX-License-Identifier: MIT
// A scene and a camera enter; why the picture would be black leaves.
#pragma once

#include <string>
#include <vector>

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// Follows paths from the camera until one finds light: none, then, or one sentence: the camera sees nothing, or no
/// light reaches what it sees, and what stands in between, faces away or reflects nothing. The same every time.
/// aspect: the picture's width over its height. Says nothing where a scene is too large to follow enough paths.
std::vector<std::string> inspect_view(const Scene& scene, const Camera& camera, double aspect, bool two_sided_lights);

}  // namespace torolux
