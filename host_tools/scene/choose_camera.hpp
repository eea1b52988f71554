// SPDX-License-Identifier: MIT
// Cameras that meshes bring along and the name that the user gave enter; the one that is meant leaves.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/scene_file.hpp"

namespace torolux {

/// The mesh's cameras where the entry places them, behind those of others.
void add_cameras(const ImportedMesh& mesh, const MeshEntry& entry, std::vector<ImportedCamera>& cameras);

/// That with the name; without a name the scene's own (of [camera]), else the first, which is told where there are
/// several. Throws InputError: no camera has the name, or the one that is chosen cannot be.
std::optional<Camera> choose_camera(const std::vector<ImportedCamera>& cameras, const std::string& name,
                                    const std::optional<Camera>& own, const Place& scene, Notices& notices);

}  // namespace torolux
