// SPDX-License-Identifier: MIT
// Puts meshes into one space and checks what only the whole can tell.
#include "host_tools/scene/build_scene.hpp"

#include <algorithm>
#include <numeric>
#include <stdexcept>

#include "host_tools/scene/keep_on.hpp"
#include "host_tools/scene/mesh_transform.hpp"
#include "host_tools/scene/number_among.hpp"
#include "host_tools/scene/resolve_material.hpp"
#include "host_tools/scene/rotation.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/texture_edges.hpp"

namespace torolux {
void SceneBuilder::check_material(SceneMaterial& material, const Place& place) {
  if (material.kind != SurfaceKind::diffuse && vec::largest(material.emission) > 0)
    refuse(place, "material " + in_quotes(material.name) +
                      " is a mirror or glass and emits; only diffuse surfaces can. Give it Ke 0, or illum 2");
  Vec3d diffuse = material.diffuse;
  if (material.texture != kNoImage) {
    const Vec3d brightest = textures_.brightest(material.texture);
    for (std::size_t c = 0; c < 3; ++c) diffuse[c] *= brightest[c];
  }
  const double most = vec::largest(vec::add(diffuse, material.specular));
  if (most >= 1) {
    notices_.note("reflectances (Kd + Ks) of one or more would never lose light: the material is scaled to 0.99",
                  place);
    material.diffuse = vec::scale(material.diffuse, 0.99 / most);
    material.specular = vec::scale(material.specular, 0.99 / most);
  }
  if (material.kind != SurfaceKind::glass) return;
  if (!(material.refractive_index >= 0.2 && material.refractive_index <= 5))
    refuse(place, "glass " + in_quotes(material.name) + " has a refractive index (Ni) of " +
                      std::to_string(material.refractive_index) + "; allowed are 0.2 to 5, glass has about 1.5");
  for (double& t : material.transmittance) {
    if (t > 1) notices_.note("Tf above one would make light: it is set to 1", place);
    t = std::min(t, 1.0);
  }
}

std::uint32_t SceneBuilder::add_material(SceneMaterial material, const TextureUse& texture, const Place& place) {
  if (material.kind == SurfaceKind::diffuse && texture.present()) material.texture = textures_.load(texture);
  check_material(material, place);
  materials_.push_back(std::move(material));
  return static_cast<std::uint32_t>(materials_.size() - 1);
}

void SceneBuilder::add_triangle(const SceneTriangle& triangle, const Place& place) {
  if (triangles_.size() >= kMostTriangles)
    refuse(place, "more than " + std::to_string(kMostTriangles) + " triangles; simplify the mesh or leave parts out");
  look_for_interruption(triangles_.size());
  triangles_.push_back(triangle);
  if (files_.empty() || files_.back() != place.file) files_.push_back(place.file);
  origins_.push_back({static_cast<std::uint32_t>(files_.size() - 1), static_cast<std::uint32_t>(place.line)});
}

/// What a corner names but cannot have is told where nothing needs it, and refused where something does.
void SceneBuilder::check_corners(ImportedTriangle& triangle, const SceneMaterial& material, bool cut,
                                 const Place& place) {
  if (triangle.normal[0] == kUnusable) {
    if (material.kind != SurfaceKind::diffuse || is_glossy(material))
      refuse(place, "a corner's normal (vn) is not there or not finite, and material " + in_quotes(material.name) +
                        " (mirror, glass or glossy) needs it; mend it, or take it out of the face to have it flat");
    notices_.note("a face's normals (vn) are not there or not finite; nothing needs them", place);
    triangle.normal.fill(kNoNormal);
  }
  if (triangle.texture_point[0] == kUnusable) {
    if (material.texture != kNoImage || cut)
      refuse(place, "a corner's texture point (vt) is not there or not finite, and material " +
                        in_quotes(material.name) + " has a texture; mend it, or take it out of the face");
    notices_.note("a face's texture points (vt) are not there or not finite; nothing needs them", place);
    triangle.texture_point.fill(kNoNormal);
  }
}

/// As the texture is looked up: scaled and moved, by whole periods as well, so that they are small.
std::uint32_t SceneBuilder::add_texture_points(const ImportedMesh& mesh, const ImportedTriangle& triangle,
                                               const TextureUse& use, const Place& place) {
  const auto first = static_cast<std::uint32_t>(texture_points_.size());
  texture_points_.resize(texture_points_.size() + 3, {0, 0});
  if (triangle.texture_point[0] == kNoNormal) {
    notices_.note("a face of a textured material without texture points (vt): it shows the texture's corner", place);
    return first;
  }
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::array<double, 3> x{};
    for (std::size_t i = 0; i < 3; ++i)
      x[i] = mesh.texture_points[triangle.texture_point[i]][axis] * use.scale[axis] + use.offset[axis];
    const double least = use.clamp ? 0 : std::floor(*std::min_element(x.begin(), x.end()));
    for (std::size_t i = 0; i < 3; ++i) {
      if (!(std::abs(x[i]) <= kMostCoordinate) || !(std::abs(x[i] - least) <= kMostRepeats))
        refuse(place,
               "a texture repeats more than 1,000,000 times over a face; its texture points (vt) are too far apart");
      texture_points_[first + i][axis] = x[i] - least;
    }
  }
  return first;
}

namespace {

SceneLamp placed_lamp(SceneLamp lamp, const MeshTransform& transform) {
  const bool left_handed = vec::dot(vec::cross(lamp.x, lamp.y), lamp.nadir) > 0;
  lamp.nadir = vec::unit(transform.normal(lamp.nadir));
  const Vec3d along = transform.direction(lamp.x);
  lamp.x = vec::unit(vec::subtract(along, vec::scale(lamp.nadir, vec::dot(along, lamp.nadir))));
  lamp.y = vec::cross(lamp.x, lamp.nadir);
  if (left_handed != transform.mirrors()) lamp.y = vec::scale(lamp.y, -1);
  return lamp;
}

}  // namespace

std::uint32_t SceneBuilder::add_lamp(const LampWeb& web, SceneLamp lamp) {
  lamp.web = number_among(webs_, web);
  return number_among(lamps_, lamp);
}

void SceneBuilder::add_mesh(const ImportedMesh& mesh, std::span<const MeshEntry> instances,
                            const std::vector<MaterialOverride>& overrides) {
  const std::size_t first = materials_.size();
  for (const MeshEntry& entry : instances) {
    for (const auto& renamed : entry.materials) {
      const std::string& from = renamed.first;
      const auto named = [&from](const ImportedMaterial& material) { return material.material.name == from; };
      if (std::ranges::none_of(mesh.materials, named))
        notices_.note("[[mesh]] 'materials' names a material that the mesh has not", entry.place, in_quotes(from));
    }
    const std::size_t own = materials_.size();
    add_instance(mesh, entry, overrides, [&](const ImportedMaterial& material) {
      const std::uint32_t added = add_material(material.material, material.texture, material.place);
      // Each PE holds all materials: instances share theirs.
      const auto earlier = std::span(materials_).subspan(first, own - first);
      const auto same = std::ranges::find(earlier, materials_.back());
      if (same == earlier.end()) return added;
      materials_.pop_back();
      return static_cast<std::uint32_t>(first + static_cast<std::size_t>(same - earlier.begin()));
    });
  }
}

void SceneBuilder::add_instance(const ImportedMesh& mesh, const MeshEntry& entry,
                                const std::vector<MaterialOverride>& overrides,
                                const std::function<std::uint32_t(const ImportedMaterial&)>& number_of) {
  constexpr std::uint32_t not_yet = 0xFFFF'FFFFU;
  std::vector<std::uint32_t> number(mesh.materials.size(), not_yet);
  std::vector<TextureUse> textures(mesh.materials.size());
  const MeshTransform transform(entry);
  const auto first_position = static_cast<std::uint32_t>(positions_.size());
  const auto first_normal = static_cast<std::uint32_t>(normals_.size());
  for (const Vec3d& p : mesh.positions) {
    const Vec3d placed = transform.position(p);
    for (const double x : placed)
      if (!(std::abs(x) <= kMostCoordinate))
        refuse(entry.place, "the transform moves the mesh beyond 1e15 in magnitude; use other units");
    positions_.push_back(vec::add(placed, {0, 0, 0}));
  }
  for (const Vec3d& n : mesh.normals) normals_.push_back(vec::scale(transform.normal(n), entry.flip ? -1.0 : 1.0));
  const bool turn = transform.mirrors() != entry.flip;
  std::vector<CutOut> cuts(mesh.materials.size());
  for (ImportedTriangle read : mesh.triangles) {
    const Place place = mesh.place_of(read);
    CutOut& cut = cuts[read.material];
    if (number[read.material] == not_yet) {
      ImportedMaterial material = resolve_material(mesh, read.material, entry, overrides, missing_, notices_);
      if (material.material.lamp != kNoMeasuredLamp) {
        const SceneLamp& lamp = mesh.lamps[material.material.lamp];
        material.material.lamp = add_lamp(mesh.webs[lamp.web], placed_lamp(lamp, transform));
      }
      number[read.material] = number_of(material);
      textures[read.material] = material.texture;
      cut = cut_out_of(material, materials_[number[read.material]]);
    }
    check_corners(read, materials_[number[read.material]], cut.mask.has_value(), place);
    SceneTriangle triangle{read.position, read.normal, number[read.material]};
    for (std::size_t i = 0; i < 3; ++i) {
      triangle.position[i] += first_position;
      if (triangle.normal[i] != kNoNormal) triangle.normal[i] += first_normal;
    }
    if (materials_[triangle.material].texture != kNoImage)
      triangle.texture_points = add_texture_points(mesh, read, textures[read.material], place);
    auto parts = cut.mask ? parts_of(cut, mesh, read, place) : std::nullopt;
    if (textures[read.material].clamp && lies_beyond_edges(triangle)) {
      if (cut.mask)
        refuse(place, "a cut-out with -clamp on whose texture points (vt) lie beyond its edge; take the option out");
      add_parts_at_edges(triangle, turn, place);
      continue;
    }
    // A lamp's front stays where its nadir is.
    if (materials_[triangle.material].lamp != kNoMeasuredLamp) {
      add_turned(triangle, transform.mirrors(), place);
      continue;
    }
    if (!parts) add_turned(triangle, turn, place);
    for (std::size_t i = 0; parts && i < parts->size(); ++i) add_turned(part_of(triangle, (*parts)[i]), turn, place);
  }
  for (std::size_t i = 0; i < number.size(); ++i)
    if (number[i] == not_yet) tell_faults(mesh.materials[i].faults, notices_);
}

SceneBuilder::CutOut SceneBuilder::cut_out_of(const ImportedMaterial& material, const SceneMaterial& placed) {
  if (placed.kind == SurfaceKind::glass) return {};
  if (material.opacity.present()) return {textures_.load_mask(material.opacity), material.opacity};
  if (placed.texture != kNoImage) return {textures_.mask(placed.texture), material.texture};
  return {};
}

std::optional<std::vector<CutOutPart>> SceneBuilder::parts_of(const CutOut& cut, const ImportedMesh& mesh,
                                                              const ImportedTriangle& read, const Place& place) {
  if (read.texture_point[0] == kNoNormal) {
    notices_.note("a face without texture points (vt) is not cut out", place);
    return std::nullopt;
  }
  std::array<std::array<double, 2>, 3> points{};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t axis = 0; axis < 2; ++axis)
      points[i][axis] = mesh.texture_points[read.texture_point[i]][axis] * cut.use.scale[axis] + cut.use.offset[axis];
  try {
    return cut_out(*cut.mask, points);
  } catch (const std::length_error&) {
    refuse(place, "a cut-out repeats too often over a face; its texture points (vt) are too far apart");
  }
}

SceneTriangle SceneBuilder::part_of(const SceneTriangle& whole, const CutOutPart& part) {
  SceneTriangle result{whole.position, whole.normal, whole.material};
  const auto mixed = [&](const std::vector<Vec3d>& values, const std::array<std::uint32_t, 3>& of,
                         const CutOutCorner& w) {
    return vec::add(vec::scale(values[of[0]], w[0]),
                    vec::add(vec::scale(values[of[1]], w[1]), vec::scale(values[of[2]], w[2])));
  };
  const auto added = [](std::vector<Vec3d>& to, const Vec3d& value) {
    to.push_back(value);
    return static_cast<std::uint32_t>(to.size() - 1);
  };
  if (whole.texture_points != kNoImage) result.texture_points = static_cast<std::uint32_t>(texture_points_.size());
  for (std::size_t i = 0; i < 3; ++i) {
    const CutOutCorner& weights = part[i];
    if (whole.texture_points != kNoImage) {
      std::array<double, 2> point{0, 0};
      for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t axis = 0; axis < 2; ++axis)
          point[axis] += weights[k] * texture_points_[whole.texture_points + k][axis];
      texture_points_.push_back(point);
    }
    // A corner of the whole stays that very corner; in between, neighbours must come to the same bits.
    const auto corner = std::ranges::find_if(weights, [](double w) { return w > 1 - 1e-9; });
    if (corner != weights.end()) {
      const auto k = static_cast<std::size_t>(corner - weights.begin());
      result.position[i] = whole.position[k];
      result.normal[i] = whole.normal[k];
      continue;
    }
    Vec3d position = mixed(positions_, whole.position, weights);
    for (double& x : position) x = static_cast<double>(static_cast<float>(x)) + 0.0;
    result.position[i] = added(positions_, position);
    if (whole.normal[0] != kNoNormal) result.normal[i] = added(normals_, mixed(normals_, whole.normal, weights));
  }
  return result;
}

bool SceneBuilder::lies_beyond_edges(const SceneTriangle& triangle) const {
  constexpr double off_the_edge = 1e-4;
  for (std::uint32_t i = 0; triangle.texture_points != kNoImage && i < 3; ++i)
    for (const double x : texture_points_[triangle.texture_points + i])
      if (x < -off_the_edge || x > 1 + off_the_edge) return true;
  return false;
}

void SceneBuilder::add_parts_at_edges(const SceneTriangle& whole, bool turn, const Place& place) {
  notices_.note("texture points (vt) beyond a texture with -clamp on: its edges go on there", place);
  const auto points = [this](std::uint32_t first) {
    return std::array{texture_points_[first], texture_points_[first + 1], texture_points_[first + 2]};
  };
  for (const CutOutPart& one : parts_at_edges(points(whole.texture_points))) {
    const SceneTriangle part = part_of(whole, one);
    auto clamped = points(part.texture_points);
    clamp_to_edges(clamped);
    std::ranges::copy(clamped, texture_points_.begin() + part.texture_points);
    add_turned(part, turn, place);
  }
}

void SceneBuilder::add_turned(SceneTriangle triangle, bool turn, const Place& place) {
  if (turn) {
    std::swap(triangle.position[1], triangle.position[2]);
    std::swap(triangle.normal[1], triangle.normal[2]);
    if (triangle.texture_points != kNoImage)
      std::swap(texture_points_[triangle.texture_points + 1], texture_points_[triangle.texture_points + 2]);
  }
  add_triangle(triangle, place);
}

void SceneBuilder::add_rectangle(const std::array<Vec3d, 4>& corners, const SceneMaterial& material,
                                 const Place& place) {
  const std::uint32_t number = add_material(material, {}, place);
  const auto first = static_cast<std::uint32_t>(positions_.size());
  positions_.insert(positions_.end(), corners.begin(), corners.end());
  const std::array<std::uint32_t, 3> flat{kNoNormal, kNoNormal, kNoNormal};
  add_triangle({{first, first + 1, first + 2}, flat, number}, place);
  add_triangle({{first, first + 2, first + 3}, flat, number}, place);
}

void SceneBuilder::add_shape(const ShapeMesh& shape, const SceneMaterial& material, const Place& place) {
  const std::uint32_t number = add_material(material, {}, place);
  const auto first = static_cast<std::uint32_t>(positions_.size());
  positions_.insert(positions_.end(), shape.positions.begin(), shape.positions.end());
  const std::array<std::uint32_t, 3> flat{kNoNormal, kNoNormal, kNoNormal};
  for (const ShapeMesh::Triangle& triangle : shape.triangles) {
    const auto& p = triangle.position;
    add_triangle({{first + p[0], first + p[1], first + p[2]}, flat, number}, place);
  }
}

vec::Box SceneBuilder::bounds() const {
  vec::Box box;
  for (const SceneTriangle& triangle : triangles_)
    for (const std::uint32_t p : triangle.position) box.include(positions_[p]);
  return box;
}

}  // namespace torolux
