// SPDX-License-Identifier: MIT
// Refinement: where a draft solution says that elements are too large for the light on them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/mesh/mesh.hpp"

namespace torolux {

/// Elements of the mesh to be cut in four, and then of their children, so that about `more` elements are added on all
/// sides: first those whose light, were it interpolated, would be most wrong, times their area (an order over the whole
/// scene, by integers). flux: of the draft, by global element, in quanta. Clusters are not cut. Ascending.
std::vector<Split> choose_splits(const Mesh& mesh, const Scene& scene, std::span<const protocol::Flux> flux,
                                 std::uint64_t more);

}  // namespace torolux
