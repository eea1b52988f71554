// SPDX-License-Identifier: MIT
// Camera rays enter; what they cost in a machine leaves, found by following some on the host: through mirrors and
// glass, by lobes, and towards emitters. For predictions and the heat; no picture depends on it.
#pragma once

#include <vector>

#include "host_tools/camera/camera_rays.hpp"
#include "host_tools/layout/stage_layout.hpp"
#include "host_tools/settings/machine_choice.hpp"
#include "host_tools/settings/quality.hpp"
#include "host_tools/setup/path_cost.hpp"

namespace torolux {

struct CameraSampleChoice {
  std::uint64_t pixels = 1;    ///< of the picture
  std::uint32_t samples = 1;   ///< of a pixel
  std::uint32_t bounces = 32;  ///< mirrors, glass and lobes on a path
  double least_weight = 1e-4;  ///< of a camera ray's own, at which a way is no longer followed
  bool shadow_rays = false;
  bool two_sided_lights = false;
  bool skip_empty_subspaces = true;
};

CameraSampleChoice camera_sample_choice(const Quality& quality, const MachineChoice& machine,
                                        const StageParameters& parameters);

struct CameraSample {
  PathSample paths;  ///< means per ray that is sent; deposits: what reaches the frame buffer
  double sent = 0;   ///< of all rays: the others miss the scene
};

/// Follows `count` rays (> 0), evenly from all over the picture; the same ones for the same picture. heat: gets their
/// ways too, if given.
CameraSample sample_camera(const Scene& scene, const Mesh& mesh, const Placement& placement, const CameraRays& rays,
                           const CameraSampleChoice& choice, std::uint32_t count, Heat* heat = nullptr);

}  // namespace torolux
