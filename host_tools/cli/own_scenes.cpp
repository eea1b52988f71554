// SPDX-License-Identifier: MIT
// A name enters, a path leaves.
#include "host_tools/cli/own_scenes.hpp"

#include <algorithm>
#include <system_error>

#include "emulator/installed_file.hpp"

namespace torolux {

namespace fs = std::filesystem;

fs::path scene_folder() {
  return installed_file("share/torolux/scenes", "../../../scenes");
}

std::vector<std::string> own_scenes() {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(scene_folder(), error))
    if (fs::exists(entry.path() / "scene.toml", error)) names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

fs::path scene_named(const fs::path& named) {
  std::error_code error;
  if (named.empty() || named != named.filename() || fs::exists(named, error)) return named;
  fs::path own = scene_folder() / named;
  return fs::exists(own / "scene.toml", error) ? own : named;
}

}  // namespace torolux
