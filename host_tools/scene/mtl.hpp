// SPDX-License-Identifier: MIT
// A material library (MTL) in, materials of Torolux out. docs/materials.md says how each key is read.
#pragma once

#include <string_view>
#include <vector>

#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

/// Appends the library's materials; one whose name is there already takes its place. Values that cannot be used are
/// kept as faults of their material. folder: of the mesh, where textures may lie as well.
void import_mtl(std::string_view text, const std::string& file, const std::filesystem::path& folder,
                std::vector<ImportedMaterial>& materials, Notices& notices);

}  // namespace torolux
