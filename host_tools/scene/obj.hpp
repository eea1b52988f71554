// SPDX-License-Identifier: MIT
// A mesh file (OBJ) and its material libraries in, one checked mesh out. docs/scenes.md says how each statement is
// read.
#pragma once

#include <filesystem>

#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

/// Material libraries are read from beside the OBJ. Throws InputError with file and line: not a number, an index that
/// is zero or names nothing, a face of fewer than three corners, an unknown statement, a library that is not there.
ImportedMesh import_obj(const std::filesystem::path& path, SceneFiles& files, const Place& asked_at, Notices& notices);

}  // namespace torolux
