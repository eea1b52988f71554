// SPDX-License-Identifier: MIT
// Shapes, room and lamps of a scene.toml enter; the scene's triangles leave.
#pragma once

#include "host_tools/scene/build_scene.hpp"
#include "host_tools/scene/scene_file.hpp"

namespace torolux {

/// Throws InputError: a material that no [material.NAME] gives, more triangles than a scene may have.
void add_shapes(const SceneFile& file, const Place& whole, SceneBuilder& builder);

/// At the middle of the room's front wall, looking at the middle of the one behind.
Camera room_camera(const RoomEntry& room);

/// After all else: a lamp that is hung without a [room] hangs in the box around the scene. Throws InputError: a lamp
/// larger than its wall, nothing to hang it in, or a measured lamp whose file is not there or is none. folder: where
/// that may lie.
void add_lamps(const SceneFile& file, const std::filesystem::path& folder, SceneFiles& files, SceneBuilder& builder,
               Notices& notices);

}  // namespace torolux
