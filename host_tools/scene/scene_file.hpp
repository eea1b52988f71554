// SPDX-License-Identifier: MIT
// The text of a scene.toml in, what it says out. docs/scenes.md lists the keys.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "host_tools/scene/files.hpp"
#include "host_tools/scene/scene.hpp"
#include "host_tools/scene/shape_entries.hpp"
#include "host_tools/scene/sky_image.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

/// How a mesh is placed and made, once.
struct MeshEntry {
  Vec3d scale{1, 1, 1};
  Vec3d rotate{0, 0, 0};  ///< degrees about x, then y, then z
  Vec3d translate{0, 0, 0};
  bool flip = false;                                           ///< fronts become backs
  std::optional<std::string> material;                         ///< for all its faces
  std::vector<std::pair<std::string, std::string>> materials;  ///< instead of the first name, the second
  Place place;
};

/// A file that is read once, and placed once or more often.
struct MeshFile {
  std::string file;  ///< relative to the scene.toml
  std::vector<MeshEntry> instances;
  Place place;
};

struct MaterialOverride {
  std::string name;
  std::optional<Vec3d> diffuse, emission, mirror, glossy, transmittance;
  std::optional<double> glass;     ///< refractive index
  std::optional<double> exponent;  ///< of glossy
  std::optional<bool> thin;        ///< of glass
  Place place;
};

struct LightEntry {
  std::array<Vec3d, 4> corners;  ///< counter-clockwise seen from the front
  Vec3d radiance;
  Vec3d diffuse{0, 0, 0};
  Place place;
};

struct SceneFile {
  std::optional<std::string> name;
  std::vector<MeshFile> meshes;
  std::vector<MaterialOverride> materials;
  std::vector<LightEntry> lights;
  std::optional<RoomEntry> room;
  std::vector<ShapeEntry> shapes;
  std::vector<LampEntry> lamps;
  std::optional<Sky> sky;
  std::optional<SkyImageEntry> sky_image;  ///< to be loaded into it
  std::optional<Camera> camera;
  SceneDefaults defaults;
};

/// Throws InputError with file and line: not TOML, an unknown key (with the nearest known one), a value of the wrong
/// kind or out of its range.
SceneFile read_scene_file(std::string_view text, const std::string& file);

}  // namespace torolux
