// SPDX-License-Identifier: MIT
// The cameras of an animation. The text of a CAMERAS.toml enters; a camera for each picture leaves. docs/walking.md
// lists the keys.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "host_tools/scene/scene.hpp"

namespace torolux {

inline constexpr std::uint64_t kMostPathFrames = 100'000;

/// In order, at least one. Between a camera and the next one, eye, point looked at, up, field of view and aperture go
/// along a Catmull-Rom spline through all of them (Catmull & Rom 1974); so does the distance of what is sharp, unless
/// all four name the same. like: has up, field of view and lens of the first, where it says none; of the others, the
/// one before. Throws InputError with file and line.
std::vector<Camera> read_camera_path(std::string_view text, const std::string& file, const Camera& like);

}  // namespace torolux
