// SPDX-License-Identifier: MIT
// From what the user names (a folder with scene.toml, a .toml or a mesh) to a checked scene.
#pragma once

#include <filesystem>
#include <optional>

#include "host_tools/scene/files.hpp"
#include "host_tools/scene/missing_materials.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

struct SceneOptions {
  bool studio = false;           ///< add a room and a lamp fitted to the mesh
  std::optional<Camera> camera;  ///< the user's own; a studio then holds it
  MissingMaterials missing_materials = MissingMaterials::refuse;
  bool strict = false;  ///< what would be told is refused
};

/// Throws InputError with file and line: not found, not parsable, NaN, index out of range, no surface with an area, ...
/// A scene without light is loaded; check_renderable refuses it. The scene always has a camera.
Scene load_scene(const std::filesystem::path& path, const SceneOptions& options);

/// The same, with files from elsewhere than the disk.
Scene load_scene_from(SceneFiles& files, const std::filesystem::path& path, const SceneOptions& options);

/// Throws InputError with all that was told, if anything was. For --strict.
void refuse_what_is_told(const std::vector<std::string>& told);

/// Throws InputError: no light, a camera that looks nowhere.
void check_renderable(const Scene& scene);

/// Throws InputError: looks nowhere, up along the view, field of view outside 0..180 degrees.
void check_camera(const Camera& camera);

}  // namespace torolux
