// SPDX-License-Identifier: MIT
// The scenes that came with this program, by their bare names.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace torolux {

/// share/torolux/scenes of the installation, or the checkout's scenes. It need not be there.
std::filesystem::path scene_folder();

/// Names of the scenes in it, in order; empty: none are there.
std::vector<std::string> own_scenes();

/// What the user means by `named`: that, where it exists or is more than a bare name; else the scene of that name that
/// came with this program; else, where there is none, `named`.
std::filesystem::path scene_named(const std::filesystem::path& named);

}  // namespace torolux
