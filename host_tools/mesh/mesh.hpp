// SPDX-License-Identifier: MIT
// The mesh: the scene's triangles enter; they leave with their lit sides, patches and elements. A function of scene and
// quality alone.
#pragma once

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "firmware/protocol/stores.hpp"
#include "host_tools/mesh/clearance.hpp"
#include "host_tools/mesh/levels.hpp"
#include "host_tools/mesh/normalise.hpp"
#include "host_tools/mesh/occlusion.hpp"
#include "host_tools/mesh/smooth_surfaces.hpp"
#include "host_tools/mesh/textures.hpp"
#include "host_tools/mesh/walls.hpp"
#include "host_tools/scene/scene.hpp"

namespace torolux {

/// An element that is cut in four, beyond what its length asks for.
struct Split {
  std::uint32_t triangle = 0;  ///< of Mesh::triangles
  std::uint32_t code = 0;      ///< protocol::location_code

  // NOLINTNEXTLINE(modernize-use-nullptr): clang-tidy 14 takes the comparison with 0 inside for a pointer
  auto operator<=>(const Split&) const = default;
};

/// What of the quality settings the mesh depends on.
struct MeshChoice {
  std::optional<double> patch_length = std::nullopt;    ///< longest edge of a patch, user units, > 0; absent: auto
  std::optional<double> element_length = std::nullopt;  ///< likewise of an element
  bool two_sided_lights = false;
  std::uint32_t texels = 16384;                 ///< at most, of each texture
  std::vector<Split> splits = {};               ///< ascending
  double patch_factor = 1, element_factor = 1;  ///< of lengths that are chosen by themselves
  double cluster_factor = 1;                    ///< of clusters, times the length of elements
};

struct MeshTriangle {
  std::array<protocol::Vec3f, 3> corner{};       ///< normalised
  std::array<std::uint32_t, 3> position{};       ///< into Scene::positions
  double area = 0;                               ///< [user units^2]
  std::uint32_t normals = protocol::kNoPolygon;  ///< index of its first of three Mesh::normals
  std::uint32_t texture = protocol::kNoTexture;  ///< number of Mesh::textures
  std::uint32_t texture_points = 0;  ///< where it has a texture: index of its first of three Mesh::texture_points
  std::uint32_t material = 0;
  std::uint8_t sides = 0;        ///< kFrontPresent | kBackPresent; 0 for mirror and glass
  std::uint8_t patch_level = 0;  ///< 4^patch_level parts, each of another patch
  std::uint32_t first_part = 0;  ///< into Mesh::parts, by path
  std::uint32_t facets = 0;      ///< of all parts; they lie one behind the other

  /// 0 to 2.
  std::uint32_t side_count() const {
    return ((sides & protocol::kFrontPresent) != 0 ? 1U : 0U) + ((sides & protocol::kBackPresent) != 0 ? 1U : 0U);
  }
};

/// What of a triangle belongs to one patch: all of it, or one triangle of its grid.
struct MeshPart {
  std::uint32_t patch = 0;
  std::uint32_t tree =
      0;  ///< node, see triangle_grid.hpp: an index into Mesh::nodes; leaves are facets from `facet` on
  std::uint32_t facet = 0;  ///< of the tree's first leaf; those of the others follow
  std::uint16_t depth = 0;  ///< nodes on the longest way down the tree; a leaf alone: 0
};

/// The flat piece of an element that one leaf of a tree stands for: all of it, a triangle of a cluster, or where walls
/// part it, one of the pieces on its side of them.
struct MeshFacet {
  std::uint32_t triangle = 0;
  std::uint32_t code = 0;     ///< protocol::location_code
  std::uint32_t element = 0;  ///< of the patch
  double of_element = 1;      ///< its part of the element's area
  bool is_piece = false;      ///< of an element that walls part from others
  /// How much of the area between what walls part, or of its own, is seen on its side of them and under no thing.
  double seen = 1;
  std::optional<std::uint32_t> sends_from = std::nullopt;  ///< sending_part()
};

struct MeshPatch {
  std::uint32_t material = 0;
  std::uint32_t first_facet = 0;
  std::uint32_t facets = 0;
  std::uint32_t elements = 0;                  ///< of each side
  std::uint32_t triangles = 1;                 ///< of the scene, of which it has something
  double area = 0;                             ///< [user units^2]
  Vec3d centre{0, 0, 0};                       ///< normalised
  std::array<std::uint32_t, 3> reflectance{};  ///< diffuse, a texture's mean; in units of 2^-32
  std::array<std::uint32_t, 2> side{protocol::kNoSide, protocol::kNoSide};           ///< front, back: global number
  std::array<std::uint32_t, 2> first_element{protocol::kNoSide, protocol::kNoSide};  ///< likewise

  /// Of the three channels.
  double mean_reflectance() const {
    return (static_cast<double>(reflectance[0]) + reflectance[1] + reflectance[2]) * 0x1p-32 / 3;
  }
  /// Joined of small triangles. Near other surfaces an element may be a single one of them.
  bool is_clustered() const { return triangles > 1; }
};

/// Global numbers run over patches in the order of their first triangles, then of its paths; front before back.
struct Mesh {
  SceneSpace space;
  std::vector<MeshTriangle> triangles;  ///< in scene order, those that vanish in float left out
  std::vector<protocol::Vec3f> normals;
  std::vector<protocol::TexturePoint> texture_points;
  std::vector<MachineTexture> textures;  ///< by number in the scene
  SmoothSurfaces smooth;
  Clearance clearance;
  Walls walls;  ///< of triangles that are cut
  Occlusion occlusion;
  std::vector<MeshPart> parts;
  std::vector<std::uint32_t> nodes;
  std::vector<MeshFacet> facets;  ///< patch by patch, there in the order of the trees' leaves
  std::vector<MeshPatch> patches;
  MeshLengths lengths;          ///< as given or chosen
  std::uint32_t materials = 0;  ///< of the scene, up to the last one that is used
  std::uint32_t patch_sides = 0;
  std::uint32_t elements = 0;  ///< of all sides
  std::vector<std::string> notes;

  double facet_area(const MeshFacet& facet) const;  ///< [user units^2]
  /// Length 1; zero for one that has no area in float.
  Vec3d facet_normal(const MeshFacet& facet) const;
  /// Of an element of a patch, [user units^2].
  double element_area(const MeshPatch& patch, std::uint32_t element) const;
  /// The facet that holds a point of a triangle with sides; b1, b2: weights of corners 1 and 2.
  std::uint32_t facet_at(std::uint32_t triangle, float b1, float b2) const;
};

/// More elements than this, of all sides, are refused: about 5 GB of element sums.
inline constexpr std::uint64_t kMostElements = std::uint64_t{1} << 26U;
/// Likewise patch sides: each takes a shot or none, and is sorted among those of all PEs.
inline constexpr std::uint64_t kMostPatchSides = std::uint64_t{1} << 23U;

/// Throws InputError: no surface left; more than kMostElements or kMostPatchSides, or more than `machine_bytes` hold
/// [bytes, of all PEs together]; told by the lengths alone, before any is made.
Mesh make_mesh(const Scene& scene, const MeshChoice& choice, std::uint64_t machine_bytes = UINT64_MAX);

/// Corners of a triangle of a polygon's grid, normalised.
std::array<Vec3d, 3> grid_corners(const MeshTriangle& triangle, std::uint32_t code);

}  // namespace torolux
