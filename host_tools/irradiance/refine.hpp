// SPDX-License-Identifier: MIT
// Refinement: two draft solutions enter; which elements are to be cut, as too large for the light on them, leaves.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/mesh/mesh.hpp"

namespace torolux {

/// Two draft solutions of one mesh that differ by chance alone.
struct DraftLight {
  std::array<std::vector<protocol::Flux>, 2> flux;  ///< that came to each element, by global number [quanta]
  double of_record = 0;                             ///< what a record carried in the mean [quanta]; 0: next to nothing
};

/// Elements of the mesh to be cut in four, and then of their children, so that about `more` elements are added on all
/// sides: first those whose light, were it interpolated, would be most wrong, times their area (an order over the whole
/// scene, by integers). Noise, by which the two solutions differ, is no reason to cut, and no element is cut whose
/// children would show noise more than light, or get next to no records. Clusters are not cut. Ascending.
std::vector<Split> choose_splits(const Mesh& mesh, const Scene& scene, const DraftLight& draft, std::uint64_t more);

}  // namespace torolux
