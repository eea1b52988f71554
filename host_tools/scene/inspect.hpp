// SPDX-License-Identifier: MIT
// For `torolux info` and `render`: a scene enters; what in it looks as if it was not meant so leaves. Nothing is
// changed.
#pragma once

#include <string>
#include <vector>

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// One sentence each, none where nothing is odd: emitters whose front meets nothing or lies against another surface;
/// glass that is open or inside out; closed solids that face inwards and rooms that face outwards; surfaces of
/// different materials in one plane (planes across an axis alone). O(n log n), and some rays for up to 64 emitting
/// triangles.
std::vector<std::string> inspect(const Scene& scene);

}  // namespace torolux
