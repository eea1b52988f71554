// SPDX-License-Identifier: MIT
// The mesh: each triangle of the scene with its sides, patches and elements. A function of scene and quality alone.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/protocol/stores.hpp"
#include "host_tools/mesh/normalise.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// What of the quality settings the mesh depends on.
struct MeshChoice {
  std::optional<double> patch_length = std::nullopt;    ///< longest edge of a patch, user units, > 0; absent: auto
  std::optional<double> element_length = std::nullopt;  ///< likewise of an element
  bool two_sided_lights = false;
};

struct MeshTriangle {
  std::array<protocol::Vec3f, 3> corner{};       ///< normalised
  std::array<std::uint32_t, 3> position{};       ///< into Scene::positions
  double area = 0;                               ///< [user units^2]
  std::uint32_t normals = protocol::kNoPolygon;  ///< index of its first of three Mesh::normals
  std::uint32_t material = 0;
  std::uint8_t sides = 0;  ///< kFrontPresent | kBackPresent; 0 for mirror and glass
  std::uint8_t patch_level = 0;
  std::uint8_t element_level = 0;
  std::uint32_t first_patch = 0;  ///< global number; 4^patch_level of them
  std::array<std::uint32_t, 2> first_side{protocol::kNoSide, protocol::kNoSide};     ///< patch side front, back: global
  std::array<std::uint32_t, 2> first_element{protocol::kNoSide, protocol::kNoSide};  ///< element front, back: global
};

/// Global numbers run over triangles in order, then paths; patches first front then back sides of a triangle.
struct Mesh {
  SceneSpace space;
  std::vector<MeshTriangle> triangles;  ///< in scene order, those that vanish in float left out
  std::vector<protocol::Vec3f> normals;
  std::uint32_t patches = 0;  ///< on one side or both
  std::uint32_t patch_sides = 0;
  std::uint32_t elements = 0;  ///< of all sides
  std::vector<std::string> notes;

  std::vector<std::uint32_t> triangle_of_patch;  ///< by global patch number
};

/// More patch sides or elements than this are refused: about 3 GB of element sums.
inline constexpr std::uint64_t kMostElements = std::uint64_t{1} << 26U;

/// Throws InputError: no surface left, or more than kMostElements.
Mesh make_mesh(const Scene& scene, const MeshChoice& choice);

/// Centre of a patch, normalised.
Vec3d patch_centre(const MeshTriangle& triangle, std::uint32_t path);

/// True where a side of this material emits: front, or either with two-sided lights.
bool emits(const SceneMaterial& material);

}  // namespace torolux
