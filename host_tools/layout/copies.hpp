// SPDX-License-Identifier: MIT
// Which subspaces stand on every PE: heat and what each would take enter; leaves: their order, greatest heat per byte
// first. The picture depends on none of it.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "firmware/protocol/stores.hpp"
#include "host_tools/layout/placement.hpp"
#include "host_tools/mesh/mesh.hpp"
#include "host_tools/subspace/grid.hpp"

namespace torolux {

/// Subspaces that stand on every PE in a stage.
struct StageCopies {
  std::uint64_t cells = 0;
  std::uint64_t bytes = 0;  ///< that they take of each PE's memory, surfaces that all have included
  std::uint64_t kept = 0;   ///< surfaces that one PE alone has (ray tracing stage)
};

/// part: of Mesh::parts, its triangle has sides.
SurfaceSize surface_size(const Mesh& mesh, std::uint32_t part);
/// Bytes of a polygon in a PE's stores: itself, normals, patch references or irradiance and tree to it, texture points.
/// What several polygons share (materials, textures) is not in it.
std::uint64_t polygon_bytes(const MeshTriangle& triangle, protocol::Stage stage);
/// The same without the surfaces of its parts, which need not stand where it does (keepers.hpp): ray tracing stage.
std::uint64_t shape_bytes(const Mesh& mesh, const MeshTriangle& triangle, protocol::Stage stage);
/// Bytes of a subspace with so many polygons, without those.
std::uint64_t cell_bytes(std::size_t polygons);

struct CopyOrder {
  std::vector<CellIndex> cells;      ///< those with polygons
  std::vector<std::uint64_t> bytes;  ///< [i]: of each PE's stores for cells[0..i], what they share counted once,
                                     ///< without surfaces
  std::vector<double> worth;         ///< [i]: heat per byte of cells[i] (those with more than a share: times
                                     ///< kMoreThanAShare), or of one before it if that is less

  /// By cell: the first `count` are marked.
  std::vector<bool> first(std::size_t count, std::size_t of_cells) const;
  /// How many of them are worth so much.
  std::size_t worth_at_least(double least) const;
};

/// By part of the mesh: heat per byte of its surface, ray tracing stage; 0 where there is none.
std::vector<double> worth_of_surfaces(const Mesh& mesh, std::span<const double> heat);

/// Takes the cell of the greatest heat per byte, again and again; before all others those with more heat than
/// `share`: their owners would keep the others waiting. What a cell shares with others that are not taken
/// yet counts in equal parts; what is already there, nothing. heat: by cell, > 0 where there are polygons. lacking: by
/// polygon, the share of the PEs that would not have it without copies, and for which alone it counts; empty: all.
CopyOrder copy_order(const Mesh& mesh, std::span<const std::vector<std::uint32_t>> polygons_of_cell,
                     protocol::Stage stage, std::span<const double> heat, std::span<const double> lacking = {},
                     double share = std::numeric_limits<double>::infinity());

}  // namespace torolux
