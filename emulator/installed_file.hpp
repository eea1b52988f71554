// SPDX-License-Identifier: MIT
// Where what belongs to this program lies: installed by its side, or built.
#pragma once

#include <filesystem>

namespace torolux {

/// installed: from the folder above the program's (the prefix, wherever it has been moved to), like
/// share/torolux/scenes. built: from the program's folder in a build. The first that exists; neither: the second.
/// Absolute, but where the program's own place is unknown.
std::filesystem::path installed_file(const std::filesystem::path& installed, const std::filesystem::path& built);

}  // namespace torolux
