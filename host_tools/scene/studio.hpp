// SPDX-License-Identifier: MIT
// --studio: a mesh in; a closed room, a ceiling lamp and a camera around it out.
#pragma once

#include "host_tools/scene/build_scene.hpp"

namespace torolux {

/// The mesh stands on the floor (y is up). The room holds `camera` as well, or, where there is none, a new one that
/// looks slightly down at the mesh from the front. Room and lamp are sized by the mesh.
void add_studio(SceneBuilder& builder, std::optional<Camera>& camera);

}  // namespace torolux
