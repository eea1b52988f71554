// SPDX-License-Identifier: MIT
// From what the user gave and what the scene suggests to what is done. An option given outweighs the scene's own
// default, which outweighs the built-in one.
#pragma once

#include "host_tools/cli/render_options.hpp"
#include "host_tools/render/render.hpp"
#include "host_tools/report/figures.hpp"
#include "host_tools/scene/load_scene.hpp"

namespace torolux {

struct Resolved {
  Camera camera;             ///< the first one of a path
  std::vector<Camera> path;  ///< empty: one picture
  Quality quality;
  std::string preset;  ///< in force, on top of which the rest was given
  MachineChoice machine;
  ToneMapping tone;
  std::vector<std::filesystem::path> outputs;  ///< empty with --no-picture alone
  RenderFiles files;
};

/// How the scene is to be loaded. Throws InputError for a camera of the user's that looks nowhere.
SceneOptions scene_options(const RenderOptions& options);

/// What to report a run by. files: as in RunInputs.
RunDescription describe(const RenderOptions& options, const Resolved& resolved, const std::string& scene_name,
                        std::vector<InputFile> files);

/// Reads the machine file, if one was named. Throws InputError, UsageError; values from the scene are checked as those
/// from the command line are, and the message says that they come from the scene.
Resolved resolve(const RenderOptions& options, const Scene& scene);

}  // namespace torolux
