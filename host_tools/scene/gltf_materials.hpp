// SPDX-License-Identifier: MIT
// Materials of a glTF file in; those of the machine, and where their textures lie, out. docs/gltf.md says how.
#pragma once

#include <optional>
#include <vector>

#include "host_tools/scene/gltf_textures.hpp"
#include "host_tools/scene/gltf_units.hpp"

namespace torolux {

struct GltfMaterial {
  ImportedMaterial material;
  GltfMapping mapping;     ///< of its texture
  bool invisible = false;  ///< its alpha leaves nothing of it
};

class GltfMaterials {
 public:
  /// data must outlive it.
  GltfMaterials(const GltfObject& root, GltfData& data, SceneFiles& files, GltfUnits units, Notices& notices)
      : root_(root), textures_(root, data, files, notices), units_(units), notices_(notices) {}

  /// Absent number: that of primitives without one.
  GltfMaterial read(std::optional<std::size_t> number);

 private:
  GltfObject root_;
  GltfTextures textures_;
  GltfUnits units_;
  Notices& notices_;
};

}  // namespace torolux
