// SPDX-License-Identifier: MIT
// A mesh file (OBJ) and its material libraries in, one checked mesh out. docs/scenes.md says how each statement is
// read.
#pragma once

#include <filesystem>

#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

/// Material libraries are looked for beside the OBJ (find_file.hpp). Throws InputError with file and line: a face with
/// a corner that is not there or not a position.
ImportedMesh import_obj(const std::filesystem::path& path, SceneFiles& files, const Place& asked_at, Notices& notices);

}  // namespace torolux
