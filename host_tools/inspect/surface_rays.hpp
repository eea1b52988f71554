// SPDX-License-Identifier: MIT
// A ray enters; the element that it sees leaves, through mirrors and glass. On the host alone, in double precision: for
// looking at a solution, not for the machine's picture.
#pragma once

#include <cstdint>
#include <optional>

#include "host_tools/camera/camera_rays.hpp"
#include "host_tools/setup/path_cost.hpp"

namespace torolux {

/// One side of an element, which a ray has met.
struct SeenElement {
  std::uint32_t triangle;  ///< of the mesh
  std::uint32_t patch;
  std::uint32_t side;                    ///< 0 front, 1 back
  std::optional<std::uint32_t> element;  ///< global number; absent: that side is not lit
};

struct Sight {
  std::optional<CellIndex> first_cell;  ///< where the first polygon was met; absent: there was none
  std::optional<SeenElement> element;   ///< absent: the ray has left the scene, or ended between mirrors
  Vec3d weight{1, 1, 1};                ///< what mirrors and glass on the way leave of its light
};

class SurfaceRays {
 public:
  /// Mirrors and glass on a way; more of them are not followed.
  static constexpr std::uint32_t kMostTurns = 16;

  /// All outlive this. placement: of any stage.
  SurfaceRays(const Scene& scene, const Mesh& mesh, const Placement& placement);

  Sight along(const CameraRay& ray);
  /// From a point within the scene. Lengths are normalised.
  Sight along(const SampleRay& ray);

 private:
  Sight along(SampleRay ray, PathCost::Cell cell);
  void turn(SampleRay& ray, const MeshTriangle& triangle, const SceneMaterial& material, Vec3d& weight) const;
  SeenElement element_at(const Meeting& met, const Vec3d& direction) const;

  const Scene& scene_;
  const Mesh& mesh_;
  const Placement& placement_;
  PathSample sample_;  // counted, and not used
  PathCost cost_;
};

/// Of an element's number: its patch and side. Throws InputError where there is no such element.
struct ElementPlace {
  std::uint32_t patch;
  std::uint32_t side;
  std::uint32_t element;  ///< of the patch
};
ElementPlace place_of_element(const Mesh& mesh, std::uint32_t element);

}  // namespace torolux
