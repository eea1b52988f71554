// SPDX-License-Identifier: MIT
// Small scenes in memory for the host tools' unit tests.
#pragma once

#include <cstdint>

#include "host_tools/layout/stage_layout.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux::test {

/// Builds a scene from quads and boxes; equal positions share an index, as in a loaded scene.
class SceneBuilder {
 public:
  std::uint32_t material(const Vec3d& diffuse, const Vec3d& emission = {0, 0, 0});
  std::uint32_t glass();
  void triangle(std::uint32_t material, const Vec3d& a, const Vec3d& b, const Vec3d& c);
  /// Corners counter-clockwise seen from the front.
  void quad(std::uint32_t material, const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d);
  /// Closed, fronts outwards (or inwards).
  void box(std::uint32_t material, const Vec3d& low, const Vec3d& high, bool inwards = false);

  Scene scene;

 private:
  std::uint32_t position(const Vec3d& at);
};

/// A unit room with a lamp of 0.4 x 0.4 that hangs 0.1 below its ceiling, and a box on stilts in it.
Scene room_with_box();

/// A floor of edge 1 with 20 x 20 x 2 triangles, a little bent, of material 0, and a lamp above.
Scene finely_tessellated_floor();

/// Of a small radiosity stage, without shadow rays or layers.
inline StageParameters stage_parameters() {
  StageParameters parameters;
  parameters.bounces = 32;
  parameters.hemicube = 16;
  parameters.shot_points = parameters.emission_points = 2;
  parameters.points_per_quantum = 1;
  parameters.pixel_scale = 0x1p40F;
  parameters.least_weight = 1e-4F;
  return parameters;
}

}  // namespace torolux::test
