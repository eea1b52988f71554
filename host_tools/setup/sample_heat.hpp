// SPDX-License-Identifier: MIT
// Paths of light and of camera rays are followed through the subspaces on the host; leaves: the heat of a stage. The
// same for the same arguments, on every computer; well under a second.
#pragma once

#include "host_tools/layout/heat.hpp"
#include "host_tools/setup/camera_sample.hpp"

namespace torolux {

/// whole: the scene on one PE, on the grid that the heat is wanted for. Where no ray stops there is none.
Heat sample_radiosity_heat(const Scene& scene, const Mesh& mesh, const Placement& whole, std::uint32_t bounces);
Heat sample_ray_heat(const Scene& scene, const Mesh& mesh, const Placement& whole, const CameraRays& rays,
                     const CameraSampleChoice& choice);

}  // namespace torolux
