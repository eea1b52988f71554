// SPDX-License-Identifier: MIT
// For tests that render: a small scene and settings in, picture and figures out, on an engine by name.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "host_tools/render/render.hpp"
#include "host_tools/scene/load_scene.hpp"

namespace torolux::test {

inline std::filesystem::path source_dir() {
  return TOROLUX_SOURCE_DIR;
}
inline std::filesystem::path data_dir() {
  return source_dir() / "tests" / "data";
}
inline std::filesystem::path pe_image() {
  return std::filesystem::path(TOROLUX_FIRMWARE_DIR) / "pe.elf";
}

/// Folders of scenes/, sorted: all that come with Torolux.
std::vector<std::string> scene_names();

/// What a test renders: change the fields that the test is about.
struct RenderCase {
  std::filesystem::path scene;
  Quality quality;
  MachineChoice machine;
  RenderFiles files;
  std::optional<Camera> camera;  ///< absent: the scene's
};

/// A case on the `native` engine (handlers compiled for the host), 1 thread per PE.
RenderCase native_case(const std::filesystem::path& scene);

RenderResult run_case(const RenderCase& render_case);

/// The picture's floats, bit for bit.
std::vector<std::byte> bytes_of(const Picture& picture);

/// Everything of the figures that must repeat exactly (no host times), as text for EXPECT_EQ.
std::string exact_figures(const RenderFigures& figures);

/// Energy identity: the greatest channel's |emitted - sum of the rest| / emitted.
double energy_error(const EnergyBalance& energy);

}  // namespace torolux::test
