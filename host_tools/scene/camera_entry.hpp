// SPDX-License-Identifier: MIT
// A table of TOML enters; the camera that it describes leaves. In a scene.toml, and in the cameras of a path.
#pragma once

#include <string>

#include "host_tools/scene/toml_table.hpp"

namespace torolux {

/// Keys eye, look_at, up, fov, aperture, focus; the caller may read others of its own, and finishes the table. title:
/// as in "[camera]". like: has up, field of view and lens of a camera that says none. Throws InputError with file and
/// line, also for a camera that looks nowhere.
Camera read_camera(TomlTable& table, const std::string& title, const Camera& like = {});

}  // namespace torolux
