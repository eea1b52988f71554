// SPDX-License-Identifier: MIT
// MGF's m, sides, rd, td, ed, rs, ts and ir enter; materials of the scene leave.
#pragma once

#include <map>
#include <optional>

#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/mgf_contexts.hpp"

namespace torolux {

/// A share of light, or what is emitted [lm/m^2], and its colour.
struct MgfPortion {
  double amount = 0;
  Chromaticity colour;
  double roughness = 0;  ///< of rs and ts: root mean square of the slopes of the surface's facets
};

struct MgfMaterial {
  bool one_sided = false;
  MgfPortion diffuse, diffuse_through, emitted, specular, specular_through;
  double index = 1, index_imaginary = 0;
  bool defined = true;  ///< false: used, but not defined in the file (scene.toml may still define it)
  Place place;
  std::vector<MaterialFault> faults;
  std::optional<std::uint32_t> number;  ///< in the mesh, since it was last changed
};

class MgfMaterials {
 public:
  MgfMaterials(ImportedMesh& mesh, Notices& notices) : mesh_(mesh), notices_(notices) {}

  static bool knows(std::string_view keyword);
  /// colour: the current one. What cannot be a material's value becomes its fault.
  void handle(const MgfStatement& statement, const Chromaticity& colour);
  /// In the mesh, of the current one.
  std::uint32_t current(const MgfStatement& use);
  /// The same, so that a surface that has 1 / share of the true one's area emits as much.
  std::uint32_t brighter(std::uint32_t number, double share);

 private:
  void select(const MgfStatement& statement);
  std::uint32_t added(ImportedMaterial material);

  ImportedMesh& mesh_;
  Notices& notices_;
  MgfContexts<MgfMaterial> materials_{"material"};
  std::map<std::string, std::vector<std::uint32_t>> by_name_;
};

/// What the machine has for it; what it has not is told.
ImportedMaterial imported_material(const std::string& name, const MgfMaterial& material, Notices& notices);

}  // namespace torolux
