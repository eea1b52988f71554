// SPDX-License-Identifier: MIT
// In this order: triangles, lit sides, lengths and levels, smooth surfaces, clearance, clusters, walls, occlusion; of
// these the patches with their trees of elements; then textures and reflectances.
#include "host_tools/mesh/mesh.hpp"

#include <algorithm>

#include "emulator/errors.hpp"
#include "firmware/protocol/triangle_grid.hpp"
#include "host_tools/mesh/clusters.hpp"
#include "host_tools/mesh/element_trees.hpp"
#include "host_tools/mesh/levels.hpp"
#include "host_tools/mesh/lit_sides.hpp"
#include "host_tools/mesh/mesh_size.hpp"
#include "host_tools/mesh/reflectance.hpp"
#include "host_tools/mesh/retriangulate.hpp"
#include "host_tools/mesh/wall_pieces.hpp"
#include "host_tools/scene/keep_on.hpp"
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
    mesh.materials = std::max(mesh.materials, from.material + 1U);
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
    const SceneMaterial& material = scene.materials[from.material];
    if (smooth && (material.kind != SurfaceKind::diffuse || is_glossy(material))) {
      triangle.normals = static_cast<std::uint32_t>(mesh.normals.size());
      for (const std::uint32_t normal : from.normal) mesh.normals.push_back(to_float(scene.normals[normal]));
    }
    if (material.texture != kNoImage) {
      triangle.texture = material.texture;
      triangle.texture_points = static_cast<std::uint32_t>(mesh.texture_points.size());
      for (std::uint32_t i = 0; i < 3; ++i) {
        const auto& [u, v] = scene.texture_points[from.texture_points + i];
        mesh.texture_points.push_back({static_cast<float>(u), static_cast<float>(v)});
      }
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
    const auto lit = [&](std::size_t side, std::uint8_t bit) {
      return emits_from(scene, material, side, choice.two_sided_lights) ? bit : std::uint8_t{0};
    };
    triangles.push_back({triangle.position, material.kind != SurfaceKind::glass,
                         static_cast<std::uint8_t>(lit(0, kFrontPresent) | lit(1, kBackPresent))});
  }
  const std::vector<std::uint8_t> sides = lit_sides(positions, triangles, scene.sky.has_value());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const bool diffuse = scene.materials[mesh.triangles[t].material].kind == SurfaceKind::diffuse;
    mesh.triangles[t].sides = diffuse ? sides[t] : 0;
  }
}

/// What decides how each triangle is cut.
struct Cutting {
  std::vector<int> patch_level;    ///< by triangle; -1: not cut
  std::vector<int> element_level;  ///< likewise, at least patch_level
  std::vector<PatchCluster> clusters;
};

/// Between a patch whose length is chosen by itself and its elements, whose is not: a patch's owner holds all of them,
/// with six levels 4,096 of each side, about half of what PEs have where nothing else is said.
constexpr int kMostLevelsOfPatch = 6;
static_assert((sizeof(protocol::Element) * 2 + sizeof(protocol::Facet) + sizeof(std::uint32_t))
                  << 2 * kMostLevelsOfPatch <=
              protocol::kDefaultLocalMemory * 3 / 4);

Cutting choose_cutting(const Scene& scene, const MeshChoice& choice, std::uint64_t machine_bytes, Mesh& mesh) {
  Cutting cutting{std::vector<int>(mesh.triangles.size(), -1), std::vector<int>(mesh.triangles.size(), -1), {}};
  std::vector<CutTriangle> cut;
  std::vector<SizedTriangle> sized;
  for (const MeshTriangle& triangle : mesh.triangles) {
    if (triangle.sides == 0) continue;
    cut.push_back({longest_edge(scene, triangle.position), triangle.area});
    sized.push_back({cut.back().longest_edge, triangle.side_count()});
  }
  std::vector<bool> small(mesh.triangles.size(), false);
  MeshLengths& lengths = mesh.lengths;
  if (!cut.empty()) {
    if (!choice.patch_length || !choice.element_length) lengths = choose_lengths(cut, count_smooth_surfaces(mesh));
    lengths.patch = choice.patch_length.value_or(lengths.patch * choice.patch_factor);
    lengths.element = choice.element_length.value_or(lengths.element * choice.element_factor);
    lengths.cluster = lengths.element * choice.cluster_factor;
    require_possible(sized, lengths, machine_bytes);
    std::size_t next = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
      if (mesh.triangles[t].sides == 0) continue;
      const double edge = cut[next++].longest_edge;
      cutting.patch_level[t] = level_for(edge, lengths.patch);
      cutting.element_level[t] = std::max<int>(cutting.patch_level[t], level_for(edge, lengths.element));
      if (!choice.patch_length)
        cutting.patch_level[t] = std::max(cutting.patch_level[t], cutting.element_level[t] - kMostLevelsOfPatch);
      small[t] = edge <= lengths.cluster / 2;
    }
  }
  look_for_interruption();
  mesh.smooth = find_smooth_surfaces(mesh, small, Pierced::ends);
  look_for_interruption();
  mesh.clearance = Clearance(mesh);
  look_for_interruption();
  cutting.clusters = find_clusters(mesh, scene, small, lengths.patch, lengths.cluster);
  for (const PatchCluster& cluster : cutting.clusters) {
    for (const ElementCluster& element : cluster) {
      for (const std::uint32_t t : element) cutting.patch_level[t] = cutting.element_level[t] = -1;
    }
  }
  std::vector<bool> cut_up;
  for (const int level : cutting.patch_level) cut_up.push_back(level >= 0);
  look_for_interruption();
  mesh.walls = Walls(mesh, cut_up);
  look_for_interruption();
  mesh.occlusion = Occlusion(mesh, scene);
  return cutting;
}

/// As MeshPart::depth.
std::uint16_t depth_of(const std::vector<std::uint32_t>& nodes, std::uint32_t node) {
  if ((node & protocol::kLeaf) != 0) return 0;
  std::uint16_t most = 0;
  for (std::uint32_t child = 0; child < 4; ++child) most = std::max(most, depth_of(nodes, nodes[node + child]));
  return static_cast<std::uint16_t>(most + 1);
}

/// Puts patches together, one after the other.
class PatchMaker {
 public:
  PatchMaker(Mesh& mesh, const Leaves& leaves) : mesh_(mesh), leaves_(leaves) {}

  void cut(std::uint32_t t, std::uint32_t level) {
    MeshTriangle& triangle = mesh_.triangles[t];
    triangle.patch_level = static_cast<std::uint8_t>(level);
    triangle.first_part = static_cast<std::uint32_t>(mesh_.parts.size());
    next_leaf_ = 0;
    for (std::uint32_t path = 0; path < protocol::triangles_of_level(level); ++path) {
      begin();
      const auto facet = static_cast<std::uint32_t>(mesh_.facets.size());
      const std::uint32_t tree = grow(t, protocol::location_code(path, level));
      mesh_.parts.push_back(
          {static_cast<std::uint32_t>(mesh_.patches.size() - 1), tree, facet, depth_of(mesh_.nodes, tree)});
      triangle.facets += static_cast<std::uint32_t>(mesh_.facets.size()) - facet;
      end();
    }
  }

  void join(const PatchCluster& cluster) {
    begin();
    for (std::uint32_t e = 0; e < cluster.size(); ++e) {
      double area = 0;
      for (const std::uint32_t t : cluster[e]) area += mesh_.triangles[t].area;
      for (const std::uint32_t t : cluster[e]) {
        MeshTriangle& triangle = mesh_.triangles[t];
        triangle.patch_level = 0;
        triangle.first_part = static_cast<std::uint32_t>(mesh_.parts.size());
        triangle.facets = 1;
        mesh_.parts.push_back({static_cast<std::uint32_t>(mesh_.patches.size() - 1), protocol::kLeaf,
                               static_cast<std::uint32_t>(mesh_.facets.size()), 0});
        mesh_.facets.push_back({t, 1, e, triangle.area / area});
      }
    }
    MeshPatch& patch = mesh_.patches.back();
    patch.elements = static_cast<std::uint32_t>(cluster.size());
    patch.triangles = static_cast<std::uint32_t>(mesh_.facets.size()) - patch.first_facet;
    end();
  }

 private:
  void begin() { mesh_.patches.emplace_back().first_facet = static_cast<std::uint32_t>(mesh_.facets.size()); }

  /// The tree below one triangle of a grid; its elements are the next ones of leaves_. Returns its node.
  std::uint32_t grow(std::uint32_t t, std::uint32_t code) {
    if (leaves_[t][next_leaf_] == code) {
      ++next_leaf_;
      return add_element(t, code);
    }
    return grow_children(code, [&](std::uint32_t child) { return grow(t, child); });
  }

  template <typename Grow>
  std::uint32_t grow_children(std::uint32_t code, const Grow& grow_child) {
    const auto first = static_cast<std::uint32_t>(mesh_.nodes.size());
    mesh_.nodes.resize(first + 4);
    for (std::uint32_t child = 0; child < 4; ++child) {
      const std::uint32_t node = grow_child(code << 2U | child);
      mesh_.nodes[first + child] = node;
    }
    return first;
  }

  /// One element, or one for each part in which walls leave it. Returns its node.
  std::uint32_t add_element(std::uint32_t t, std::uint32_t code) {
    look_for_interruption();
    MeshPatch& patch = mesh_.patches.back();
    const auto [pieces, parts] =
        mesh_.walls.cross(t, code) ? wall_parts(mesh_, t, code) : WallParts{{{code, 0}}, {{1, true}}};
    const auto first = static_cast<std::uint32_t>(mesh_.facets.size());
    for (const auto& [piece, number] : pieces) {
      const WallParts::Part& part = parts[number];
      MeshFacet& facet = mesh_.facets.emplace_back(MeshFacet{t, piece, patch.elements + number});
      facet.seen = part.seen ? part.area : 0;
      if (pieces.size() == 1) continue;
      facet.is_piece = true;
      const std::uint32_t deeper = protocol::level_of_code(piece) - protocol::level_of_code(code);
      facet.of_element = 1 / (part.area * protocol::triangles_of_level(deeper));
    }
    patch.elements += static_cast<std::uint32_t>(parts.size());
    std::uint32_t next = first;
    return grow_pieces(code, next);
  }

  std::uint32_t grow_pieces(std::uint32_t code, std::uint32_t& next) {
    if (mesh_.facets[next].code == code) return protocol::kLeaf | (next++ - mesh_.patches.back().first_facet);
    return grow_children(code, [&](std::uint32_t child) { return grow_pieces(child, next); });
  }

  void end() {
    MeshPatch& patch = mesh_.patches.back();
    patch.facets = static_cast<std::uint32_t>(mesh_.facets.size()) - patch.first_facet;
    const MeshTriangle& first = mesh_.triangles[mesh_.facets[patch.first_facet].triangle];
    patch.material = first.material;
    for (std::uint32_t f = 0; f < patch.facets; ++f) {
      const MeshFacet& facet = mesh_.facets[patch.first_facet + f];
      const auto corner = grid_corners(mesh_.triangles[facet.triangle], facet.code);
      const double area = mesh_.facet_area(facet);
      patch.centre = vec::add(patch.centre, vec::scale(vec::add(vec::add(corner[0], corner[1]), corner[2]), area / 3));
      patch.area += area;
    }
    patch.centre = vec::scale(patch.centre, 1 / patch.area);
    for (std::uint32_t side = 0; side < 2; ++side) {
      if ((first.sides & (side == 0 ? kFrontPresent : kBackPresent)) == 0) continue;
      patch.side[side] = mesh_.patch_sides++;
      patch.first_element[side] = mesh_.elements;
      mesh_.elements += patch.elements;
    }
  }

  Mesh& mesh_;
  const Leaves& leaves_;
  std::size_t next_leaf_ = 0;
};

void make_patches(const Cutting& cutting, const std::vector<Split>& splits, Mesh& mesh) {
  const Leaves leaves = element_leaves(mesh, cutting.element_level, splits);
  PatchMaker maker(mesh, leaves);
  std::size_t next_cluster = 0;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    look_for_interruption(t);
    if (cutting.patch_level[t] >= 0) maker.cut(t, static_cast<std::uint32_t>(cutting.patch_level[t]));
    if (next_cluster < cutting.clusters.size() && cutting.clusters[next_cluster][0][0] == t) {
      maker.join(cutting.clusters[next_cluster++]);
    }
  }
}

void take_textures(const Scene& scene, std::uint32_t most_texels, Mesh& mesh) {
  for (const SceneTexture& texture : scene.textures) mesh.textures.push_back(machine_texture(texture, most_texels));
  for (const MeshTriangle& triangle : mesh.triangles) {
    if (triangle.texture == protocol::kNoTexture) continue;
    for (std::uint32_t i = triangle.texture_points; i < triangle.texture_points + 3; ++i)
      mesh.texture_points[i] = mesh.textures[triangle.texture].placed(mesh.texture_points[i]);
  }
}

/// The scene but for its images' texels, its flat regions cut anew.
Scene retriangulated(const Scene& scene) {
  Scene cut;
  cut.name = scene.name;
  cut.positions = scene.positions;
  cut.normals = scene.normals;
  cut.texture_points = scene.texture_points;
  cut.triangles = scene.triangles;
  cut.materials = scene.materials;
  for (const SceneTexture& texture : scene.textures)
    cut.textures.push_back({texture.file, texture.width, texture.height, {}, texture.clamped});
  cut.sky = scene.sky;
  cut.webs = scene.webs;
  cut.lamps = scene.lamps;
  retriangulate(cut);
  return cut;
}

}  // namespace

Mesh make_mesh(const Scene& scene, const MeshChoice& choice, std::uint64_t machine_bytes) {
  look_for_interruption();
  const Scene cut = retriangulated(scene);
  Mesh mesh;
  mesh.space = scene_space(cut);
  take_triangles(cut, mesh);
  look_for_interruption();
  choose_sides(cut, choice, mesh);
  make_patches(choose_cutting(cut, choice, machine_bytes, mesh), choice.splits, mesh);
  for (MeshFacet& facet : mesh.facets) facet.sends_from = sending_part(mesh, facet);
  take_textures(scene, choice.texels, mesh);
  set_reflectances(scene, mesh);
  return mesh;
}

Vec3d Mesh::facet_normal(const MeshFacet& facet) const {
  const auto& corner = triangles[facet.triangle].corner;
  const Vec3d across = vec::cross(vec::subtract(to_double(corner[1]), to_double(corner[0])),
                                  vec::subtract(to_double(corner[2]), to_double(corner[0])));
  return vec::length(across) > 0 ? vec::unit(across) : across;
}

std::array<Vec3d, 3> grid_corners(const MeshTriangle& triangle, std::uint32_t code) {
  const protocol::GridTriangle grid = protocol::grid_triangle_of(code);
  constexpr double one = 1U << protocol::kMostLevels;
  std::array<Vec3d, 3> corners{};
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t w = 0; w < 3; ++w) {
      corners[c] = vec::add(corners[c], vec::scale(to_double(triangle.corner[w]), grid.corner[c][w] / one));
    }
  }
  return corners;
}

double Mesh::facet_area(const MeshFacet& facet) const {
  return triangles[facet.triangle].area / protocol::triangles_of_level(protocol::level_of_code(facet.code));
}

double Mesh::element_area(const MeshPatch& patch, std::uint32_t element) const {
  const auto begin = facets.begin() + patch.first_facet;
  const auto facet =
      std::find_if(begin, begin + patch.facets, [&](const MeshFacet& f) { return f.element == element; });
  return facet_area(*facet) / facet->of_element;
}

std::uint32_t Mesh::facet_at(std::uint32_t triangle, float b1, float b2) const {
  protocol::Weights at{(1.0F - b1) - b2, b1, b2};
  const MeshTriangle& of = triangles[triangle];
  const MeshPart& part = parts[of.first_part + protocol::enter_level(at, of.patch_level)];
  return part.facet + protocol::find_leaf(nodes.data(), part.tree, at);
}

}  // namespace torolux
