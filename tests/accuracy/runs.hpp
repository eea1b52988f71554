// SPDX-License-Identifier: MIT
// What the reports have in common: which scenes at which settings, and where their tables go.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host_tools/cli/resolve.hpp"
#include "tests/accuracy/reference_pictures.hpp"
#include "tests/accuracy/settings.hpp"

namespace torolux::accuracy {

struct ReportChoice {
  std::vector<std::filesystem::path> scenes;
  std::vector<std::string> settings;  ///< names of kSettings; empty: all
  std::string engine = "native";
  std::uint32_t shrink = 2;  ///< pictures are this many times less wide and high than the scene's own
  ReferenceEffort reference;
  std::uint32_t surface_paths = 1U << 21U;  ///< of the path tracer, on all surfaces of a scene
  unsigned threads = 0;                     ///< of this computer; 0: all cores
  std::filesystem::path output;             ///< folder
};

struct SceneRun {
  Scene scene;
  Resolved resolved;  ///< as the command line has it; the machine: one PE of the chosen engine
};

/// A scene without light gets the studio. Throws InputError.
SceneRun resolve_scene(const std::filesystem::path& path, const ReportChoice& choice);

std::vector<Setting> chosen_settings(const ReportChoice& choice);

/// User and system time of this process so far.
double cpu_seconds();

}  // namespace torolux::accuracy
