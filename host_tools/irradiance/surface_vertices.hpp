// SPDX-License-Identifier: MIT
// The mesh and a side enter; leaves: which corners of elements share their light there, those that meet on a smooth
// surface with no wall between them.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "host_tools/mesh/mesh.hpp"

namespace torolux {

class SurfaceVertices {
 public:
  /// side: 0 front, 1 back.
  SurfaceVertices(const Mesh& mesh, std::uint32_t side);

  /// Numbers of the vertices at a facet's corners, each below count().
  const std::array<std::uint32_t, 3>& corners(std::uint32_t facet) const { return corner_[facet]; }
  std::size_t count() const { return open_.size(); }
  /// Whether elements lie on one part of the way around it only: at a border, or at a wall.
  bool open(std::uint32_t vertex) const { return open_[vertex]; }

  /// A vertex on a larger element's edge, so far from one of its ends to the other, 0..1.
  struct Hanging {
    std::uint32_t vertex, from, to;
    double along;
  };
  /// Larger elements come first, so that their corners are known.
  const std::vector<Hanging>& hanging() const { return hanging_; }

 private:
  std::vector<std::array<std::uint32_t, 3>> corner_;
  std::vector<bool> open_;
  std::vector<Hanging> hanging_;
};

}  // namespace torolux
