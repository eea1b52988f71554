// SPDX-License-Identifier: MIT
// MGF's ies (a measured lamp, IESNA LM-63) enters; its opening, a material and how it shines leave, in the mesh.
#pragma once

#include <filesystem>

#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/measured_lamp.hpp"
#include "host_tools/scene/mgf_statements.hpp"
#include "host_tools/scene/mgf_transform.hpp"

namespace torolux {

/// ies FILE [-m FACTOR] [TRANSFORM]
class MgfLamp {
 public:
  /// folder: where the file may lie. Throws InputError: no file, a factor that is not above 0, or what read_ies
  /// refuses.
  MgfLamp(const MgfStatement& statement, const std::filesystem::path& folder, SceneFiles& files, Notices& notices);

  /// Number of the argument with which its transform begins.
  std::size_t transform() const { return transform_; }
  /// Centre at the origin, nadir along -z, turn from x to y, all placed. line: of the mesh's own file. Throws
  /// InputError: the mesh would have more than `most` triangles, or too many lamps that hang differently.
  void hang(const MgfPlacement& placement, std::uint32_t line, std::size_t most, ImportedMesh& mesh) const;

 private:
  std::uint32_t material_of(const SceneLamp& lamp, const Place& place, ImportedMesh& mesh) const;

  Place place_;
  std::string name_;
  std::size_t transform_ = 1;
  MeasuredLamp measured_;
  Vec3d emission_{0, 0, 0};
};

}  // namespace torolux
