// SPDX-License-Identifier: MIT
// What a run is reported by: the summary for people, the statistics for programs.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "host_tools/files/digest.hpp"
#include "host_tools/render/render.hpp"

namespace torolux {

/// What a render takes in.
struct RunInputs {
  std::string scene_path;  ///< as the user named it
  bool studio = false;
  bool missing_are_white = false;  ///< --missing-materials white
  bool gltf_in_lumens = false;     ///< --gltf-units lumen
  std::string camera_name;         ///< --camera; "": not given
  /// Of eye, look_at, up, field_of_view, aperture and focus: those that the user gave, which matters to a studio.
  std::vector<std::string> camera_given;
  std::vector<InputFile> files;  ///< scene files in the order in which they are read, saved radiosity, firmware
};

/// What was asked for, as resolved from command line, scene and built-in values.
struct RunDescription {
  std::string scene;  ///< its name
  Quality quality;
  MachineChoice machine;
  std::vector<std::filesystem::path> pictures;
  std::string preset;
  Camera camera;
  ToneMapping tone;
  RunInputs inputs;
};

/// emitted - (absorbed + absorbed_specular + unshot + escaped + cut_off + back_side), relative to emitted: the channel
/// where it is greatest. 0 where nothing was emitted.
double closing_error(const EnergyBalance& energy);

/// Of a PE's memory, 0..1.
double copies_share(const StageCopies& copies, const RenderFigures& figures);

/// busy / (busy + idle), 0..1; 0 for a PE that did not run.
double busy_share(const PeFigures& pe);

/// Several lines, each ended. Aligned in columns, at most 79 characters wide.
std::string summary(const RunDescription& run, const RenderFigures& figures);

/// One JSON object, ended by a line end. docs/command_line.md lists its keys. The same for every repetition of a run,
/// but for the values at wall_seconds and host.
std::string stats_json(const RunDescription& run, const RenderFigures& figures);

}  // namespace torolux
