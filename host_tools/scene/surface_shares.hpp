// SPDX-License-Identifier: MIT
// A scene enters; what part of its surface emits, or turns light, leaves.
#pragma once

#include "host_tools/scene/scene.hpp"

namespace torolux {

/// More than an eighth of the surface emits: such emitters cast no sharp shadows, and rays that leave surfaces at
/// random find them.
bool has_large_emitters(const Scene& scene);

/// 0..1: of mirror, glass or glossy materials. Panes let light through unturned, and do not count.
double turning_share(const Scene& scene);

}  // namespace torolux
