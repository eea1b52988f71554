// SPDX-License-Identifier: MIT
// What lies under occluders that stand on a surface: no light comes there and nothing of it is seen, though elements
// lie half under the occluder's foot and half beside it. A function of scene alone.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "host_tools/mesh/solid_angle.hpp"
#include "host_tools/mesh/walls.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

struct MeshFacet;

class Occlusion {
 public:
  /// Of the mesh's triangles with their materials.
  Occlusion(const Mesh& mesh, const Scene& scene);
  /// Nothing is hidden.
  Occlusion() = default;

  /// Whether all ways from a point of a triangle, on one side (0 front, 1 back), end inside one opaque occluder that
  /// the triangle is no part of and that has no emitter in it.
  bool occludes(const Mesh& mesh, std::uint32_t triangle, std::uint32_t side, const PlanePoint& point) const;

 private:
  /// Triangles that hang together by edges.
  struct Occluder {
    vec::Box box;
    SolidAngle angle;
  };

  /// By occluder: whether an emitter is inside.
  std::vector<bool> lit_inside(const Mesh& mesh, const Scene& scene) const;

  void find_near(const Mesh& mesh);

  std::vector<Occluder> occluders_;               ///< that may hide
  std::vector<std::uint32_t> occluder_of_;        ///< by triangle; >= occluders_.size(): none of them
  std::vector<std::vector<std::uint32_t>> near_;  ///< by triangle: those that it may lie under
};

/// Of a triangle of a grid.
PlanePoint middle_of_grid(std::uint32_t code);

/// Whether a occluder hides a triangle of a polygon's grid, on either side. Of one that a wall touches nothing is
/// known: no.
bool is_hidden(const Mesh& mesh, std::uint32_t triangle, std::uint32_t code);

/// The part of a facet from which it sends light: all of it where nothing is hidden, else one that is not and that no
/// wall touches. Absent: there is none. A location code.
std::optional<std::uint32_t> sending_part(const Mesh& mesh, const MeshFacet& facet);

}  // namespace torolux
