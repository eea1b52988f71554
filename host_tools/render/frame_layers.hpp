// SPDX-License-Identifier: MIT
// From the frame buffer's integers to the picture and its further layers.
#pragma once

#include <string>
#include <vector>

#include "emulator/host/host_program.hpp"
#include "host_tools/picture/layers.hpp"
#include "host_tools/setup/setup.hpp"

namespace torolux {

Picture picture_of(const FrameBuffer& frame_buffer, const RenderSetup& setup);

/// SHA-256 of width, height and the plane's sums, 8 bytes each, little endian.
std::string digest_of(const FrameBuffer& frame_buffer, protocol::Plane plane);

/// Those of setup.parameters.layers, in the order of kLayerNames.
std::vector<Layer> layers_of(const FrameBuffer& frame_buffer, const RenderSetup& setup);

}  // namespace torolux
