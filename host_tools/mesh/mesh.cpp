// SPDX-License-Identifier: MIT
// See mesh.hpp.
#include "host_tools/mesh/mesh.hpp"

#include <algorithm>

#include "emulator/errors.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/levels.hpp"
#include "host_tools/mesh/sides.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

using protocol::kBackPresent;
using protocol::kFrontPresent;

bool has_area_in_float(const std::array<protocol::Vec3f, 3>& corner) {
  const Vec3d a = vec::subtract(to_double(corner[1]), to_double(corner[0]));
  const Vec3d b = vec::subtract(to_double(corner[2]), to_double(corner[0]));
  // Below this the float normal on the PE loses all its digits.
  return vec::length(vec::cross(a, b)) > 1e-7 * vec::length(a) * vec::length(b) && vec::length(a) > 0 &&
         vec::length(b) > 0;
}

double longest_edge(const Scene& scene, const std::array<std::uint32_t, 3>& position) {
  double longest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    longest = std::max(
        longest, vec::length(vec::subtract(scene.positions[position[(i + 1) % 3]], scene.positions[position[i]])));
  }
  return longest;
}

void take_triangles(const Scene& scene, Mesh& mesh) {
  std::size_t vanished = 0;
  for (const SceneTriangle& from : scene.triangles) {
    MeshTriangle triangle;
    triangle.position = from.position;
    triangle.material = from.material;
    for (std::size_t i = 0; i < 3; ++i) {
      triangle.corner[i] = to_float(mesh.space.to_normalised(scene.positions[from.position[i]]));
    }
    if (!has_area_in_float(triangle.corner)) {
      ++vanished;
      continue;
    }
    const Vec3d a = vec::subtract(scene.positions[from.position[1]], scene.positions[from.position[0]]);
    const Vec3d b = vec::subtract(scene.positions[from.position[2]], scene.positions[from.position[0]]);
    triangle.area = 0.5 * vec::length(vec::cross(a, b));
    const bool smooth = std::find(from.normal.begin(), from.normal.end(), kNoNormal) == from.normal.end();
    if (smooth && scene.materials[from.material].kind != SurfaceKind::diffuse) {
      triangle.normals = static_cast<std::uint32_t>(mesh.normals.size());
      for (const std::uint32_t normal : from.normal) mesh.normals.push_back(to_float(scene.normals[normal]));
    }
    mesh.triangles.push_back(triangle);
  }
  if (mesh.triangles.empty()) throw InputError("scene '" + scene.name + "' has no surface with an area");
  if (vanished > 0) {
    mesh.notes.push_back(std::to_string(vanished) + " triangles left out: too thin or small for single precision");
  }
}

void choose_sides(const Scene& scene, const MeshChoice& choice, Mesh& mesh) {
  std::vector<Vec3d> positions;
  positions.reserve(scene.positions.size());
  for (const Vec3d& position : scene.positions) positions.push_back(mesh.space.to_normalised(position));
  std::vector<SideTriangle> triangles;
  triangles.reserve(mesh.triangles.size());
  for (const MeshTriangle& triangle : mesh.triangles) {
    const SceneMaterial& material = scene.materials[triangle.material];
    const std::uint8_t lit =
        choice.two_sided_lights ? (kFrontPresent | kBackPresent) : static_cast<std::uint8_t>(kFrontPresent);
    triangles.push_back(
        {triangle.position, material.kind != SurfaceKind::glass, emits(material) ? lit : static_cast<std::uint8_t>(0)});
  }
  const std::vector<std::uint8_t> sides = lit_sides(positions, triangles);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool diffuse = scene.materials[mesh.triangles[t].material].kind == SurfaceKind::diffuse;
    mesh.triangles[t].sides = diffuse ? sides[t] : 0;
  }
}

void cut(const Scene& scene, const MeshChoice& choice, Mesh& mesh) {
  std::vector<double> edges;
  for (const MeshTriangle& triangle : mesh.triangles) {
    if (triangle.sides != 0) edges.push_back(longest_edge(scene, triangle.position));
  }
  const std::vector<Levels> levels = choose_levels(edges, choice.patch_length, choice.element_length);
  std::uint64_t elements = 0;
  std::size_t next = 0;
  for (MeshTriangle& triangle : mesh.triangles) {
    if (triangle.sides == 0) continue;
    triangle.patch_level = levels[next].patch;
    triangle.element_level = levels[next].element;
    ++next;
    const std::uint64_t sides = triangle.sides == (kFrontPresent | kBackPresent) ? 2 : 1;
    elements += sides * protocol::triangles_of_level(triangle.element_level);
  }
  if (elements > kMostElements) {
    throw InputError("the mesh would have " + std::to_string(elements) + " elements on all sides, at most " +
                     std::to_string(kMostElements) + " are allowed: use a greater --elements or --patches");
  }
}

void number(Mesh& mesh) {
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    MeshTriangle& triangle = mesh.triangles[t];
    if (triangle.sides == 0) continue;
    const std::uint32_t patches = protocol::triangles_of_level(triangle.patch_level);
    triangle.first_patch = mesh.patches;
    mesh.patches += patches;
    mesh.triangle_of_patch.insert(mesh.triangle_of_patch.end(), patches, t);
    for (std::uint32_t side = 0; side < 2; ++side) {
      if ((triangle.sides & (side == 0 ? kFrontPresent : kBackPresent)) == 0) continue;
      triangle.first_side[side] = mesh.patch_sides;
      triangle.first_element[side] = mesh.elements;
      mesh.patch_sides += patches;
      mesh.elements += protocol::triangles_of_level(triangle.element_level);
    }
  }
}

}  // namespace

bool emits(const SceneMaterial& material) {
  return material.kind == SurfaceKind::diffuse &&
         std::any_of(material.emission.begin(), material.emission.end(), [](double value) { return value > 0; });
}

Mesh make_mesh(const Scene& scene, const MeshChoice& choice) {
  Mesh mesh;
  mesh.space = scene_space(scene);
  take_triangles(scene, mesh);
  choose_sides(scene, choice, mesh);
  cut(scene, choice, mesh);
  number(mesh);
  return mesh;
}

Vec3d patch_centre(const MeshTriangle& triangle, std::uint32_t path) {
  const protocol::GridTriangle grid = protocol::grid_triangle(path, triangle.patch_level);
  constexpr double one = 1U << protocol::kMostLevels;
  Vec3d centre{0, 0, 0};
  for (std::size_t w = 0; w < 3; ++w) {
    const double weight = (grid.corner[0][w] + grid.corner[1][w] + grid.corner[2][w]) / (3 * one);
    centre = vec::add(centre, vec::scale(to_double(triangle.corner[w]), weight));
  }
  return centre;
}

}  // namespace torolux
