// SPDX-License-Identifier: MIT
// MGF's f, fh, sph, cyl, cone, ring, prism and torus enter, placed; triangles of the mesh leave.
#pragma once

#include <vector>

#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/mgf_contexts.hpp"
#include "host_tools/scene/mgf_materials.hpp"
#include "host_tools/scene/mgf_transform.hpp"
#include "host_tools/scene/shapes.hpp"

namespace torolux {

struct MgfVertex {
  Vec3d point{0, 0, 0}, normal{0, 0, 0};  ///< normal: unit, or zero: none
  std::string fault;                      ///< of what was read last; empty: none
  Place fault_place;
};

/// v, p and n.
class MgfVertices {
 public:
  static bool knows(std::string_view keyword);
  void handle(const MgfStatement& statement);
  /// Throws InputError: not defined, or its point or normal cannot be.
  const MgfVertex& found(const MgfStatement& statement, std::string_view name);

 private:
  MgfContexts<MgfVertex> vertices_{"vertex"};
};

class MgfSurfaces {
 public:
  /// most: triangles, and a third of the positions; more are refused.
  MgfSurfaces(ImportedMesh& mesh, MgfMaterials& materials, MgfVertices& vertices, Notices& notices, std::size_t most)
      : mesh_(mesh), materials_(materials), vertices_(vertices), notices_(notices), most_(most) {}

  static bool knows(std::string_view keyword);
  /// line: of the mesh's own file. Throws InputError: vertices, normals or radii that are not what the shape needs,
  /// too many triangles.
  void handle(const MgfStatement& statement, const MgfPlacement& placement, std::size_t line);
  /// Curved surfaces become triangles, as fine as the whole asks for.
  void finish();

 private:
  struct Curved {
    Shape shape;
    std::uint32_t material, line;
  };
  struct Corner {
    Vec3d point, normal;
  };

  void face(const MgfStatement& statement, const MgfPlacement& placement);
  void face_with_holes(const MgfStatement& statement, const MgfPlacement& placement);
  void prism(const MgfStatement& statement, const MgfPlacement& placement);
  Shape sphere(const MgfStatement& statement, const MgfPlacement& placement);
  Shape cone(const MgfStatement& statement, const MgfPlacement& placement);
  Shape ring_or_torus(const MgfStatement& statement, const MgfPlacement& placement);
  Corner corner(const MgfStatement& statement, std::string_view name);
  double radius(const MgfStatement& statement, std::size_t i) const;
  void add_polygon(std::vector<Corner> corners, const MgfStatement& statement, const MgfPlacement& placement);
  void add_curved(const Curved& curved, const Roundness& roundness);
  Roundness roundness_of(const Curved& curved, double size) const;
  void check_count(const MgfStatement& statement) const;
  std::string too_many() const;

  ImportedMesh& mesh_;
  MgfMaterials& materials_;
  MgfVertices& vertices_;
  Notices& notices_;
  std::size_t most_;
  std::uint32_t material_ = 0, line_ = 0;  ///< of the surface at hand
  std::vector<Curved> curved_;
};

}  // namespace torolux
