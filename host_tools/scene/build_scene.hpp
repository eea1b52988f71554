// SPDX-License-Identifier: MIT
// Meshes, transforms and materials in; one checked Scene out: equal positions merged, triangles without area and exact
// duplicates left out, reflectances below one.
#pragma once

#include <functional>
#include <optional>
#include <span>

#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/scene_file.hpp"
#include "host_tools/scene/shapes.hpp"
#include "host_tools/scene/textures.hpp"

namespace torolux {

class SceneBuilder {
 public:
  /// files: where textures come from.
  SceneBuilder(SceneFiles& files, MissingMaterials missing, Notices& notices)
      : notices_(notices), missing_(missing), textures_(files, missing, notices) {}

  /// Once for each instance; they share materials. Overrides by name apply to all meshes. Throws InputError: a material
  /// that neither the mesh nor an override defines.
  void add_mesh(const ImportedMesh& mesh, std::span<const MeshEntry> instances,
                const std::vector<MaterialOverride>& overrides);
  /// Four corners, counter-clockwise seen from the front.
  void add_rectangle(const std::array<Vec3d, 4>& corners, const SceneMaterial& material, const Place& place);

  void add_shape(const ShapeMesh& shape, const SceneMaterial& material, const Place& place);

  /// lamp.web is set here. Returns what a material calls it.
  std::uint32_t add_lamp(const LampWeb& web, SceneLamp lamp);

  /// Of all that was added so far.
  vec::Box bounds() const;

  /// Whether any triangle added so far has an area.
  bool has_surface() const;

  /// Positions, normals, triangles and the materials in use. Throws InputError: no surface with an area.
  void finish(Scene& scene, const Place& place);

 private:
  /// number_of: adds a material, or finds it among those that are there.
  void add_instance(const ImportedMesh& mesh, const MeshEntry& entry, const std::vector<MaterialOverride>& overrides,
                    const std::function<std::uint32_t(const ImportedMaterial&)>& number_of);
  std::uint32_t add_material(SceneMaterial material, const TextureUse& texture, const Place& place);
  std::uint32_t add_texture_points(const ImportedMesh& mesh, const ImportedTriangle& triangle, const TextureUse& use,
                                   const Place& place);
  /// A mask, and how it lies on faces.
  struct CutOut {
    std::optional<CutOutMask> mask;
    TextureUse use;
  };
  /// placed: the material as the scene has it.
  CutOut cut_out_of(const ImportedMaterial& material, const SceneMaterial& placed);
  /// Absent: all of the triangle is there.
  std::optional<std::vector<CutOutPart>> parts_of(const CutOut& cut, const ImportedMesh& mesh,
                                                  const ImportedTriangle& read, const Place& place);
  /// Of its texture.
  bool lies_beyond_edges(const SceneTriangle& triangle) const;
  void add_parts_at_edges(const SceneTriangle& whole, bool turn, const Place& place);
  SceneTriangle part_of(const SceneTriangle& whole, const CutOutPart& part);
  void add_turned(SceneTriangle triangle, bool turn, const Place& place);
  void check_corners(ImportedTriangle& triangle, const SceneMaterial& material, bool cut, const Place& place);
  void check_material(SceneMaterial& material, const Place& place);
  void add_triangle(const SceneTriangle& triangle, const Place& place);

  Notices& notices_;
  MissingMaterials missing_;
  TextureLibrary textures_;
  std::vector<Vec3d> positions_;
  std::vector<Vec3d> normals_;
  std::vector<std::array<double, 2>> texture_points_;
  std::vector<SceneTriangle> triangles_;
  std::vector<SceneMaterial> materials_;
  std::vector<LampWeb> webs_;
  std::vector<SceneLamp> lamps_;
  std::vector<std::string> files_;
  struct Origin {
    std::uint32_t file, line;
  };
  std::vector<Origin> origins_;  ///< of each triangle
};

}  // namespace torolux
