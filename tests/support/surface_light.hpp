// SPDX-License-Identifier: MIT
// The light that falls on the surfaces of a scene, in groups of triangles: by the path tracer, and in a solution.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tests/references/world.hpp"
#include "tests/support/solve_scene.hpp"

namespace torolux::test {

/// On one group [W], R G B.
struct GroupLight {
  std::array<double, 3> flux{};
  std::array<double, 3> variance{};  ///< of flux; of a solution 0

  double all() const;  ///< flux of all channels
  /// Standard deviation of all() over all(), at most: as if the channels went together.
  double relative_noise() const;
  double relative_noise(std::size_t channel) const;
};

/// By group: what paths from evenly spread points of its triangles find, on the sides that the mesh has.
/// group: of each triangle. paths: of each group, about; a group without any has no light.
std::vector<GroupLight> traced_light(const references::World& world, const Mesh& mesh,
                                     std::span<const std::uint32_t> group, std::span<const std::uint32_t> paths);

/// As many paths for each group as are its share of the area of all.
std::vector<std::uint32_t> paths_by_area(const references::World& world, std::span<const std::uint32_t> group,
                                         std::uint32_t paths);

/// By group: what fell on the elements. No patch has triangles of two groups.
std::vector<GroupLight> solved_light(const SolvedScene& solved, std::span<const std::uint32_t> group);

}  // namespace torolux::test
