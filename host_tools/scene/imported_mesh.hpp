// SPDX-License-Identifier: MIT
// What the OBJ and MTL importers hand to the scene builder: one file's triangles and materials, in the file's units.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "host_tools/scene/files.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// map_Kd: an image, and what is done with texture points before it is looked up.
struct TextureUse {
  std::string file;  ///< as found from the material library; empty: none
  std::array<double, 2> scale{1, 1}, offset{0, 0};
  Place place;
};

/// A material as read; checks of its values come after scene.toml's overrides.
struct ImportedMaterial {
  SceneMaterial material;
  bool defined = true;  ///< false: used by faces, but in no library (scene.toml may still define it)
  Place place;          ///< its newmtl, or its first use
  TextureUse texture{};
};

struct ImportedTriangle {
  std::array<std::uint32_t, 3> position;
  std::array<std::uint32_t, 3> normal;  ///< all kNoNormal where a corner has none
  std::uint32_t material;               ///< into ImportedMesh::materials
  std::uint32_t line;                   ///< of its face
  std::array<std::uint32_t, 3> texture_point{kNoNormal, kNoNormal, kNoNormal};  ///< all kNoNormal where one has none
};

struct ImportedMesh {
  std::string file;
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;  ///< as written, any length
  std::vector<std::array<double, 2>> texture_points;
  std::vector<ImportedTriangle> triangles;
  std::vector<ImportedMaterial> materials;
};

/// More are refused, with the number: what a PE's polygon numbers and this computer's memory bear with ease.
inline constexpr std::size_t kMostTriangles = 4'000'000;
/// Largest magnitude of a coordinate: its square still has room in a float.
inline constexpr double kMostCoordinate = 1e15;

}  // namespace torolux
