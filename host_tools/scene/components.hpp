// SPDX-License-Identifier: MIT
// Triangles of a scene in, the surfaces they form out: joined along edges, closed or open, with their volume.
#pragma once

#include <cstdint>
#include <vector>

#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

struct Component {
  std::vector<std::uint32_t> triangles;
  vec::Box box;
  bool closed = false;   ///< every edge is met once in each direction
  double volume = 0;     ///< of a closed one; above 0: fronts outwards [scene units^3]
  bool one_way = false;  ///< no edge of two triangles is met twice in one direction: the winding is consistent
};

/// By shared edges among triangles of the same kind (diffuse, mirror, glass); in the order of their first triangles.
std::vector<Component> components(const Scene& scene);

}  // namespace torolux
