// SPDX-License-Identifier: MIT
// The list of polygons of one subspace: its polygons in, their entries out, where there are many in groups that lie
// close together.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "firmware/protocol/polygon_boxes.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/subspace/grid.hpp"

namespace torolux {

/// Entries of a subspace with so many polygons, groups' own included.
std::uint64_t listed_entries(std::size_t polygons);

/// listed_entries(polygons.size()) entries; ListedPolygon::polygon is a number in `triangles`. polygons: ascending.
std::vector<protocol::ListedPolygon> list_polygons(std::span<const MeshTriangle> triangles,
                                                   std::span<const std::uint32_t> polygons, const Grid& grid,
                                                   CellIndex cell);

}  // namespace torolux
