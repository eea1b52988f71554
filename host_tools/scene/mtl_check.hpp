// SPDX-License-Identifier: MIT
// The check before tinyobjloader: MTL text in; known statements with good values, and what is wrong with others, out.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

/// What the check alone knows of a material.
struct CheckedMaterial {
  std::string name;  ///< may be empty
  Place place;
  bool has_kd = false, has_ni = false, has_ns = false;
  std::optional<double> dissolve{}, transparency{};  ///< d and Tr, as written, 0..1
  TextureUse texture{}, opacity{};
  std::vector<MaterialFault> faults{};  ///< at most one for each value: the last statement counts
};

/// The library as it may be handed on: known statements with good values, materials named 0, 1, ...
struct CheckedLibrary {
  std::vector<CheckedMaterial> materials;
  std::string text;
};

/// folder: of the mesh, where textures may lie as well.
CheckedLibrary check_mtl(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                         Notices& notices);

}  // namespace torolux
