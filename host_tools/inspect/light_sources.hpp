// SPDX-License-Identifier: MIT
// A solution and an element enter; the patches from which its light comes leave, the greatest first. Found on the host
// by looking from the element back into the solved scene: the machine's records do not say who sent them.
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/inspect/answers.hpp"
#include "host_tools/inspect/surface_rays.hpp"
#include "host_tools/solution/solution.hpp"

namespace torolux {

/// Rays for each element: shares of a few per cent are good to about a tenth of themselves.
inline constexpr std::uint32_t kSourceRays = 16384;

/// Of all patches, by what they have sent there. The same for the same solution.
std::vector<LightSource> light_sources(const Scene& scene, const RenderSetup& setup, const Solution& solution,
                                       const ElementPlace& place);

}  // namespace torolux
