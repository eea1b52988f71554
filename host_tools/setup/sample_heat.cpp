// SPDX-License-Identifier: MIT
// A placement on one PE enters, so that the heat is that of grid and scene alone. The paths are those of
// path_sample.hpp and camera_sample.hpp, which note each step.
#include "host_tools/setup/sample_heat.hpp"

#include "host_tools/setup/path_sample.hpp"

namespace torolux {
namespace {

/// Paths from emitters, and camera rays: some fifty visits for each of a thousand full subspaces.
constexpr std::uint32_t kPaths = 8000;

}  // namespace

Heat sample_radiosity_heat(const Scene& scene, const Mesh& mesh, const Placement& whole, std::uint32_t bounces) {
  Heat heat = heat_for(whole.polygons_of_cell);
  heat.deposits.resize(mesh.patches.size());
  sample_light(scene, mesh, whole, bounces, kPaths, &heat);
  return heat;
}

Heat sample_ray_heat(const Scene& scene, const Mesh& mesh, const Placement& whole, const CameraRays& rays,
                     const CameraSampleChoice& choice) {
  Heat heat = heat_for(whole.polygons_of_cell);
  heat.surfaces.resize(mesh.parts.size());
  sample_camera(scene, mesh, whole, rays, choice, kPaths, &heat);
  return heat;
}

}  // namespace torolux
