// SPDX-License-Identifier: MIT
// A mesh's triangles enter; how far the nearest one is of those that a place on a surface sees before it leaves.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "host_tools/scene/vec.hpp"

namespace torolux {

/// What is looked for from a point of a surface.
struct Outlook {
  Vec3d point{0, 0, 0};
  Vec3d normal{0, 0, 0};  ///< of the plane that the surface has there, length 1
  double rise = 0;        ///< what of a triangle rises less over that plane does not count
  std::uint32_t own = 0;  ///< nor do the triangles of this surface,
  double facing = 0;      ///< nor those whose normal has a lesser cosine to the plane's, either way round
};

/// A binary tree of boxes, halved at the middle triangle across the longest extent.
class TriangleTree {
 public:
  struct Triangle {
    std::array<Vec3d, 3> corner{};
    std::uint32_t surface = 0;  ///< any number but kSeveral
  };

  TriangleTree() = default;  ///< none
  explicit TriangleTree(std::vector<Triangle> triangles);

  /// To the nearest point of what counts; `reach` if that is not nearer.
  double distance(const Outlook& outlook, double reach) const;

 private:
  static constexpr std::uint32_t kSeveral = 0xFFFF'FFFFU;
  struct Node {
    vec::Box box;
    std::uint32_t first = 0;    ///< of a leaf: in triangles_; else number of the first of two children
    std::uint32_t count = 0;    ///< of triangles; 0: no leaf
    std::uint32_t surface = 0;  ///< of all triangles, or kSeveral
  };
  void build(std::uint32_t node, std::size_t first, std::size_t count);
  void look(const Node& node, const Outlook& outlook, double& nearest) const;
  bool may_count(const Node& node, const Outlook& outlook) const;

  std::vector<Triangle> triangles_;
  std::vector<Node> nodes_;
};

}  // namespace torolux
