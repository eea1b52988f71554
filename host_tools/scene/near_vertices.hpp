// SPDX-License-Identifier: MIT
// Points in; positions of a scene out, one for all that lie within a short way of one another.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <vector>

#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

class NearVertices {
 public:
  /// low: corner of the scene's box. near: [scene units].
  NearVertices(Scene& scene, const Vec3d& low, double near) : scene_(scene), low_(low), near_(near) {}

  /// A position of the scene.
  void add(std::uint32_t position);
  /// The position at a point, an old one where there is one near to it.
  std::uint32_t at(const Vec3d& point);
  /// Takes positions back, from this number on.
  void forget_from(std::size_t position);
  /// All that were added or made.
  std::vector<std::uint32_t> all() const;

 private:
  std::array<long, 3> cell_of(const Vec3d& point) const;

  Scene& scene_;
  Vec3d low_;
  double near_;
  std::map<std::array<long, 3>, std::vector<std::uint32_t>> cells_;
  std::vector<bool> known_;  ///< by position: it stands in a cell
};

}  // namespace torolux
