// SPDX-License-Identifier: MIT
// A glTF 2.0 file (.gltf with its neighbours, or .glb) in; its scene as one mesh, with materials and cameras, out.
#pragma once

#include "host_tools/scene/gltf_units.hpp"
#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

/// How each part is read: docs/gltf.md. Throws InputError "FILE: mesh 0 'Box', primitive 1: what is wrong".
ImportedMesh import_gltf(const std::filesystem::path& path, SceneFiles& files, const Place& asked_at, GltfUnits units,
                         Notices& notices);

}  // namespace torolux
