// SPDX-License-Identifier: MIT
// From what the user names (a folder with scene.toml, a .toml or an .obj) to a checked scene.
#pragma once

#include <filesystem>

#include "host_tools/scene/scene.hpp"

namespace torolux {

struct SceneOptions {
  bool studio = false;  ///< add a room and a lamp fitted to the mesh
};

/// Throws InputError with file and line: not found, not parsable, NaN, index out of range, no surface with an area, ...
/// A scene without light is loaded; check_renderable refuses it.
Scene load_scene(const std::filesystem::path& path, const SceneOptions& options);

/// Throws InputError: no light, a camera that looks nowhere.
void check_renderable(const Scene& scene);

}  // namespace torolux
