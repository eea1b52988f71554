// SPDX-License-Identifier: MIT
// What the fuzzers of a path's cameras and of the commands of a display's page do with their bytes: read them as the
// program does, use what was read, let only refusals pass.
#pragma once

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>

#include "emulator/errors.hpp"
#include "host_tools/display/walk.hpp"
#include "host_tools/scene/camera.hpp"
#include "host_tools/scene/camera_path.hpp"

namespace torolux {

/// True: taken; each of its cameras sees something. False: refused with a message that names the file.
inline bool load_camera_path_text(const std::string& text) {
  try {
    const std::vector<Camera> cameras = read_camera_path(text, "fuzzed.toml", {});
    if (cameras.empty() || cameras.size() > kMostPathFrames) __builtin_trap();
    for (const Camera& camera : cameras)
      if (camera_fault(camera)) __builtin_trap();
    return true;
  } catch (const InputError& error) {
    if (!std::string(error.what()).starts_with("fuzzed.toml")) __builtin_trap();
    return false;
  }
}

/// Does what a view or a change of pace would be done with, if the bytes are one.
inline bool obey_command(const std::string& text) {
  const auto command = nlohmann::json::parse(text, nullptr, false);
  if (command.is_discarded() || !command.is_object() || !command.contains("do")) return false;
  try {
    if (command["do"] == "view") {
      if (camera_fault(camera_of(command, {{0, 0, 1}, {0, 0, 0}}))) __builtin_trap();
      return true;
    }
    if (command["do"] != "pace") return false;
    Pace pace;
    pace.obey(command);
    pace.lets(1'000'000);
    if (pace.packets().size() < sizeof(PacketsHeader)) __builtin_trap();
    return true;
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace torolux
