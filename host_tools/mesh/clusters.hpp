// SPDX-License-Identifier: MIT
// Small triangles of smooth surfaces enter; clusters leave: neighbours that receive and shoot as one, so that the cost
// of a scene follows from quality and not from how finely a surface happens to be tessellated.
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/mesh/clearance.hpp"
#include "host_tools/mesh/mesh.hpp"

namespace torolux {

/// Triangles of one element.
using ElementCluster = std::vector<std::uint32_t>;
/// Elements of one patch: at least eight triangles in all.
using PatchCluster = std::vector<ElementCluster>;

/// small: triangles that may be part of a cluster. Lengths: about the greatest extent, user units; elements are smaller
/// where another surface is near. Clusters in the order of their first triangles; none holds a triangle twice, and what
/// has few neighbours is in none.
std::vector<PatchCluster> find_clusters(const Mesh& mesh, const Scene& scene, const std::vector<bool>& small,
                                        double patch_length, double element_length);

/// Smooth surfaces that the mesh has, were all its triangles small.
std::uint32_t count_smooth_surfaces(const Mesh& mesh);

}  // namespace torolux
