// SPDX-License-Identifier: MIT
// A mesh's material, its entry in scene.toml and overrides enter; the material that the scene has leaves.
#pragma once

#include <vector>

#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/scene_file.hpp"
#include "host_tools/scene/textures.hpp"

namespace torolux {

/// The mesh's material of this number: renamed, overridden, and white where it is nowhere and that is allowed. Its
/// faults are told. Throws InputError: nowhere, or a fault in a value that it needs.
ImportedMaterial resolve_material(const ImportedMesh& mesh, std::size_t number, const MeshEntry& entry,
                                  const std::vector<MaterialOverride>& overrides, MissingMaterials missing,
                                  Notices& notices);

/// Tells the faults of a material that does not count.
void tell_faults(const std::vector<MaterialFault>& faults, Notices& notices);

}  // namespace torolux
