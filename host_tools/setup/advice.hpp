// SPDX-License-Identifier: MIT
// A scene with settings that no PE's memory holds enters; why, and options with which it fits, leave.
#pragma once

#include <string>
#include <vector>

#include "emulator/engines/image/image.hpp"
#include "host_tools/setup/setup.hpp"

namespace torolux {

/// What is refused, for the message: what the fullest PE needs and has, and up to three ways out, "--pe-memory 4M; or
/// --pes 8x8; or --elements 40 --patches 80", of which each was tried and is enough by itself. Where none is: the one
/// that was found to leave least. Takes some times what make_setup takes. setup: has no memory, of the other arguments.
std::string does_not_fit(const Scene& scene, const Camera& camera, const Quality& quality, const MachineChoice& machine,
                         const Image& image, const std::vector<Split>& splits, const RenderSetup& setup);

}  // namespace torolux
