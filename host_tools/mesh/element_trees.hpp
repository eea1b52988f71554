// SPDX-License-Identifier: MIT
// Levels, walls, what hangs over elements, and splits enter; leaves: which triangles of each triangle's grid are
// elements, balanced.
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/mesh/clearance.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {

/// By triangle: location codes of its elements in the order of their paths; empty without sides.
using Leaves = std::vector<std::vector<std::uint32_t>>;

/// base_level: by triangle, at least its patch_level; -1: is not cut (part of a cluster, or no sides). splits:
/// ascending. Balanced (B. Von Herzen, A. Barr, "Accurate triangulations of deformed, intersecting surfaces", SIGGRAPH
/// 1987): on a smooth surface no element lies at the edge of one more than twice as large.
Leaves element_leaves(const Mesh& mesh, const std::vector<int>& base_level, const std::vector<Split>& splits);

}  // namespace torolux
