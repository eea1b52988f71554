// SPDX-License-Identifier: MIT
// A material library (MTL) in, materials of Torolux out. docs/materials.md says how each key is read.
#pragma once

#include <string_view>
#include <vector>

#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

/// Appends the library's materials. Throws InputError with file and line: a value missing, not a number or negative,
/// a statement before newmtl, a name given twice.
void import_mtl(std::string_view text, const std::string& file, std::vector<ImportedMaterial>& materials,
                Notices& notices);

}  // namespace torolux
