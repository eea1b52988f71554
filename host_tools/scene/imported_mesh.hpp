// SPDX-License-Identifier: MIT
// What the importers of OBJ, MTL and glTF hand to the scene builder: one file's triangles and materials, in the file's
// units.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "host_tools/scene/files.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// map_Kd: an image, and what is done with texture points before it is looked up.
struct TextureUse {
  std::vector<std::string> names;            ///< of the file as written, the likeliest reading first; none: no texture
  std::shared_ptr<const std::string> bytes;  ///< of an image that no file of its own holds; its name says which it is
  double cutoff = 0.5;                       ///< of alpha: what has less is not there. 0: alpha is not used
  std::array<double, 2> scale{1, 1}, offset{0, 0};
  double base = 0, gain = 1;  ///< of the file's values, 0..1: base + gain * value
  char channel = 0;           ///< of an image of opacity: r, g, b, l (brightness), m (alpha); 0: alpha, else brightness
  bool clamp = false;         ///< it does not repeat: its edges go on
  bool optional = false;      ///< the name may be the last number of an option: no texture where it is no file
  Place place;
  std::vector<std::filesystem::path> folders;  ///< where it may lie: the library's, then the mesh's

  bool present() const { return !names.empty(); }
};

/// What a material library says of a material, as far as it can be wrong.
enum class MaterialValue : std::uint8_t {
  diffuse,
  specular,
  exponent,
  emission,
  index,
  filter,
  model,
  texture,
  opacity
};

/// Refused where the material needs the value, else told.
struct MaterialFault {
  MaterialValue value;
  Place place;
  std::string message;
};

/// A material as read; checks of its values come after scene.toml's overrides.
struct ImportedMaterial {
  SceneMaterial material;
  bool defined = true;  ///< false: used by faces, but in no library (scene.toml may still define it)
  Place place;          ///< its newmtl, or its first use
  TextureUse texture{};
  TextureUse opacity{};  ///< map_d
  std::vector<MaterialFault> faults{};
};

/// Of a corner whose normal or texture point is named, but not there or not finite.
inline constexpr std::uint32_t kUnusable = 0xFFFF'FFFEU;

struct ImportedTriangle {
  std::array<std::uint32_t, 3> position;
  std::array<std::uint32_t, 3> normal;  ///< all kNoNormal where a corner has none, or all kUnusable
  std::uint32_t material;               ///< into ImportedMesh::materials
  std::uint32_t line;                   ///< of its face; where the mesh has parts, which of them
  std::array<std::uint32_t, 3> texture_point{kNoNormal, kNoNormal, kNoNormal};  ///< likewise
};

/// Of a file that has several; one of them is chosen by its name.
struct ImportedCamera {
  std::vector<std::string> names;  ///< any of them
  Camera camera;                   ///< in the file's space
  Place place;
};

/// A sun of a file that has one.
struct ImportedSun {
  Vec3d direction;   ///< towards it, in the file's space, any length
  Vec3d irradiance;  ///< on a surface that faces it [W/m^2]
  Place place;
};

struct ImportedMesh {
  std::string file;
  std::vector<std::string> parts;  ///< of a file without lines: what messages call the places of its faces
  std::vector<Vec3d> positions;
  std::vector<Vec3d> normals;  ///< as written, any length
  std::vector<std::array<double, 2>> texture_points;
  std::vector<ImportedTriangle> triangles;
  std::vector<ImportedMaterial> materials;
  std::vector<std::pair<std::string, Place>> missing_libraries;
  std::vector<ImportedCamera> cameras;
  std::vector<ImportedSun> suns;
  std::vector<LampWeb> webs;     ///< of measured lamps
  std::vector<SceneLamp> lamps;  ///< that materials name, in the file's space

  Place place_of(const ImportedTriangle& triangle) const {
    return parts.empty() ? Place{file, triangle.line} : Place{parts[triangle.line], 0};
  }
};

/// More are refused, with the number: what a PE's polygon numbers and this computer's memory bear with ease.
inline constexpr std::size_t kMostTriangles = 4'000'000;
/// Largest magnitude of a coordinate: its square still has room in a float.
inline constexpr double kMostCoordinate = 1e15;

}  // namespace torolux
