// SPDX-License-Identifier: MIT
// The nodes of a glTF file in; those of its scene, placed, out.
#pragma once

#include <cstddef>
#include <vector>

#include "host_tools/scene/affine.hpp"
#include "host_tools/scene/gltf_data.hpp"

namespace torolux {

struct PlacedNode {
  std::size_t number;
  Affine place;
};

/// Parents before children, in the file's order. Of several scenes the default one, else the first; without any, all
/// nodes. Throws InputError: a node that is below itself, or has two parents.
std::vector<PlacedNode> placed_nodes(const GltfDocument& document, Notices& notices);

/// Where a node's mesh stands: once, or with EXT_mesh_gpu_instancing many times.
std::vector<Affine> instances(const GltfObject& node, const Affine& place, GltfData& data, std::size_t accessors);

}  // namespace torolux
