// SPDX-License-Identifier: MIT
// A surface of triangles and a point in; the surface's solid angle seen from there, out, without a look at each
// triangle.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/scene/vec.hpp"

namespace torolux {

/// A surface closed by a fan over its border has 4 pi times the number of its signed crossings by any ray; less the
/// fan, which is short, that is the surface's own solid angle. Crossings are found in a tree of boxes.
class SolidAngle {
 public:
  using Triangle = std::array<Vec3d, 3>;
  /// Of the rays: along no axis, diagonal or plane that a modeller would choose.
  static constexpr Vec3d kDirection{0.3711593, 0.7893571, 0.4890241};

  SolidAngle() = default;
  /// border: edges that one triangle has, as it runs through them; all others are met once each way.
  SolidAngle(std::vector<Triangle> triangles, std::span<const std::array<Vec3d, 2>> border);

  /// [steradians]; triangles that are seen from behind count against those that are seen from the front.
  double seen_from(const Vec3d& point) const;

 private:
  struct Node {
    vec::Box box;
    std::uint32_t first = 0, count = 0;  ///< of a leaf: triangles; else count is 0,
    std::uint32_t right = 0;             ///< and the children are the next node and this one
  };
  void build(std::uint32_t first, std::uint32_t count);
  int crossings(const Vec3d& point) const;

  std::vector<Triangle> triangles_;  ///< with the fan
  std::vector<Triangle> fan_;
  std::vector<Node> nodes_;  ///< none: too few triangles to be worth it
};

}  // namespace torolux
