// SPDX-License-Identifier: MIT
// From the frame buffer's integers to the picture and its further layers.
#pragma once

#include <string>
#include <vector>

#include "emulator/host/host_program.hpp"
#include "host_tools/picture/layers.hpp"
#include "host_tools/setup/setup.hpp"
#include "host_tools/stages/sample_plan.hpp"

namespace torolux {

/// samples: that each pixel has had; of one without any, light may be under way.
Picture picture_of(const FrameBuffer& frame_buffer, const RenderSetup& setup, const SampleCounts& samples = {});

/// SHA-256 of width, height and the plane's sums, 8 bytes each, little endian.
std::string digest_of(const FrameBuffer& frame_buffer, protocol::Plane plane);

/// Those of setup.parameters.layers, in the order of kLayerNames.
std::vector<Layer> layers_of(const FrameBuffer& frame_buffer, const RenderSetup& setup,
                             const SampleCounts& samples = {});

}  // namespace torolux
