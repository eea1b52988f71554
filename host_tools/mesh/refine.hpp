// SPDX-License-Identifier: MIT
// Refinement: where a draft solution says that elements are too large for the light on them.
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/mesh/mesh.hpp"

namespace torolux {

/// What a draft found.
struct DraftLight {
  std::vector<protocol::Flux> flux;  ///< that came to each element, by global number [quanta]
  double of_record = 0;              ///< what a record carried in the mean [quanta]; 0: elements' light has no noise
};

/// Elements of the mesh to be cut in four, and then of their children, so that about `more` elements are added on all
/// sides: first those whose light, were it interpolated, would be most wrong, times their area (an order over the whole
/// scene, by integers). Noise is no reason to cut, nor are elements cut whose children would get next to no records.
/// Clusters are not cut. Ascending.
std::vector<Split> choose_splits(const Mesh& mesh, const Scene& scene, const DraftLight& draft, std::uint64_t more);

}  // namespace torolux
