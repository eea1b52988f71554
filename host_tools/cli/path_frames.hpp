// SPDX-License-Identifier: MIT
// --path: cameras of an animation enter; a picture of each leaves, all made by one machine of one solved scene.
#pragma once

#include <filesystem>
#include <functional>
#include <vector>

#include "host_tools/cli/resolve.hpp"
#include "host_tools/render/session.hpp"

namespace torolux {

/// like: as in read_camera_path. Throws InputError: cannot be read, or says what no path may say.
std::vector<Camera> load_camera_path(const std::filesystem::path& file, const Camera& like);

/// walk.png -> walk.0001.png; number: counted from 1; of: how many there are (four digits, or as many as that has).
std::filesystem::path frame_file(const std::filesystem::path& file, std::size_t number, std::size_t of);

/// After the first picture, which the session has made and is written here, too: all others, each written as it comes.
/// tell: called before each, with its number and how many there are; false ends it. Fills in figures.path.
void render_path(RenderSession& session, const Resolved& resolved, RenderResult& first,
                 const std::function<bool(std::size_t, std::size_t)>& tell);

}  // namespace torolux
