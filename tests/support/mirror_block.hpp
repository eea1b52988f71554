// SPDX-License-Identifier: MIT
// The Cornell box with a mirror for its tall block: solutions in; how far the light on each wall is from the path
// tracer's out.
#pragma once

#include <array>
#include <span>
#include <string_view>
#include <vector>

#include "tests/support/surface_light.hpp"

namespace torolux::test {

/// tests/data/scenes/cornell_mirror.
std::filesystem::path mirror_block_scene();

/// By quadrilateral (two triangles each), of those that wall_errors() looks at.
/// effort: times the paths that bring the noise of each wall to 0.3 to 0.5 %, of the block's sides to 0.8 to 1.4 %.
std::vector<GroupLight> traced_mirror_block(double effort);

struct WallError {
  std::string_view wall;
  bool of_block;  ///< a side of the other block
  double error;   ///< of the channel that is farthest off, relative, signed
  double noise;   ///< standard deviation of what the path tracer has for that channel, relative
};

/// Of mean radiosity, which is the light that falls on a wall times the wall's reflectance over its area: of floor,
/// ceiling, walls, and the other block's sides.
std::vector<WallError> wall_errors(const SolvedScene& solved, std::span<const GroupLight> traced);

}  // namespace torolux::test
