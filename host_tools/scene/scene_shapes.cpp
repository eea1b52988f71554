// SPDX-License-Identifier: MIT
// Makes the surfaces that scene.toml describes.
#include "host_tools/scene/scene_shapes.hpp"

#include <algorithm>
#include <array>
#include <numbers>

#include "emulator/nearest_name.hpp"
#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/measured_lamp.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

/// Edges of a circle where none are given; of what bends light.
constexpr std::uint32_t kEdges = 48, kLensEdges = 128;
constexpr const char* kNoMaterial = "(none)";

/// The mesh that the shapes of one scene.toml form.
class ShapeCollector {
 public:
  ShapeCollector(const SceneFile& file, const Place& whole) : file_(file) { mesh_.file = whole.file; }

  void add(const ShapeEntry& entry) {
    const std::uint32_t material = material_of(entry.material, entry.title, entry.place);
    const std::uint32_t edges = entry.edges.value_or(bends_light(entry.material) ? kLensEdges : kEdges);
    const Roundness roundness = exactly(edges);
    for (const Shape& part : entry.parts) {
      if (mesh_.triangles.size() + triangles_of(part, roundness) > kMostTriangles)
        refuse(entry.place, "more than " + std::to_string(kMostTriangles) + " triangles; lower 'edges'");
      ShapeMesh shape = tessellated(part, roundness);
      if (entry.flip) shape.flip();
      add_triangles(shape, material, entry.place);
    }
  }

  void add(const RoomEntry& room) {
    const Box box{room.corner, {{{room.size[0], 0, 0}, {0, room.size[1], 0}, {0, 0, room.size[2]}}}};
    for (std::size_t i = 0; i < kWallNames.size(); ++i) {
      if (room.open[i]) continue;
      ShapeMesh wall = tessellated(face(box, i / 2, i % 2 == 1), exactly(kEdges));
      wall.flip();
      add_triangles(wall, material_of(room.materials[i], "[room]", room.place), room.place);
    }
  }

  const ImportedMesh& mesh() const { return mesh_; }

  /// As many edges for every circle, rounded up to a number that circles have.
  static Roundness exactly(std::uint32_t edges) {
    Roundness roundness{0, 12, edges};
    roundness.least = roundness.most = roundness.edges(1);
    return roundness;
  }

 private:
  const MaterialOverride* given(const std::string& name) const {
    const auto found = std::ranges::find(file_.materials, name, &MaterialOverride::name);
    return found == file_.materials.end() ? nullptr : &*found;
  }

  bool bends_light(const std::optional<std::string>& name) const {
    const MaterialOverride* material = name ? given(*name) : nullptr;
    return material != nullptr && material->glass && !material->thin.value_or(false);
  }

  std::uint32_t material_of(const std::optional<std::string>& name, const std::string& title, const Place& place) {
    SceneMaterial material;
    material.name = name.value_or(kNoMaterial);
    material.diffuse = {0.7, 0.7, 0.7};
    if (name && given(*name) == nullptr) {
      std::vector<std::string> known;
      for (const MaterialOverride& other : file_.materials) known.push_back(other.name);
      refuse(place, title + " is made of material " + in_quotes(*name) + ", but there is no [material." + *name + "]" +
                        did_you_mean(*name, known));
    }
    const auto same = std::ranges::find_if(
        mesh_.materials, [&](const ImportedMaterial& other) { return other.material.name == material.name; });
    if (same != mesh_.materials.end()) return static_cast<std::uint32_t>(same - mesh_.materials.begin());
    mesh_.materials.push_back({material, true, place});
    return static_cast<std::uint32_t>(mesh_.materials.size() - 1);
  }

  void add_triangles(const ShapeMesh& shape, std::uint32_t material, const Place& place) {
    const auto first = static_cast<std::uint32_t>(mesh_.positions.size());
    const auto first_normal = static_cast<std::uint32_t>(mesh_.normals.size());
    mesh_.positions.insert(mesh_.positions.end(), shape.positions.begin(), shape.positions.end());
    mesh_.normals.insert(mesh_.normals.end(), shape.normals.begin(), shape.normals.end());
    for (const ShapeMesh::Triangle& triangle : shape.triangles) {
      ImportedTriangle out{triangle.position, triangle.normal, material, static_cast<std::uint32_t>(place.line)};
      for (std::uint32_t& p : out.position) p += first;
      for (std::uint32_t& n : out.normal)
        if (n != kNoNormal) n += first_normal;
      mesh_.triangles.push_back(out);
    }
  }

  const SceneFile& file_;
  ImportedMesh mesh_;
};

/// The rectangle or disc at its wall, a hair before it.
Shape hung(const HungLamp& lamp, const vec::Box& room, const Place& place) {
  const auto wall = static_cast<std::size_t>(lamp.wall);
  const std::size_t axis = wall / 2;
  const bool upper = wall % 2 == 1;
  // What runs along the wall first, and then: z and y at sides, x and z at floor and ceiling, x and y before and
  // behind.
  constexpr std::array<std::array<std::size_t, 2>, 3> kAlong{{{2, 1}, {0, 2}, {0, 1}}};
  const Vec3d extent = room.extent();
  Vec3d centre = room.centre();
  centre[axis] = upper ? room.high[axis] - 0.01 * extent[axis] : room.low[axis] + 0.01 * extent[axis];
  std::array<Vec3d, 2> half{};
  for (std::size_t i = 0; i < 2; ++i) {
    const std::size_t along = kAlong[axis][i];
    centre[along] += lamp.offset[i];
    half[i][along] = lamp.radius > 0 ? lamp.radius : 0.5 * lamp.size[i];
    if (!(half[i][along] > 0)) refuse(place, "[[lamp]] has no area");
    if (centre[along] - half[i][along] < room.low[along] || centre[along] + half[i][along] > room.high[along])
      refuse(place, "[[lamp]] does not lie within its wall, which is " + std::to_string(extent[kAlong[axis][0]]) +
                        " by " + std::to_string(extent[kAlong[axis][1]]));
  }
  Vec3d normal{0, 0, 0};
  normal[axis] = upper ? -1 : 1;
  if (lamp.radius > 0) return Ring{centre, normal, 0, lamp.radius};
  const auto corner = [&](double u, double v) {
    return vec::add(centre, vec::add(vec::scale(half[0], u), vec::scale(half[1], v)));
  };
  Quad quad{{corner(-1, -1), corner(1, -1), corner(1, 1), corner(-1, 1)}};
  if (vec::dot(vec::cross(half[0], half[1]), normal) < 0) std::swap(quad.corners[1], quad.corners[3]);
  return quad;
}

}  // namespace

void add_shapes(const SceneFile& file, const Place& whole, SceneBuilder& builder) {
  if (file.shapes.empty() && !file.room) return;
  ShapeCollector collector(file, whole);
  if (file.room) collector.add(*file.room);
  for (const ShapeEntry& entry : file.shapes) collector.add(entry);
  builder.add_mesh(collector.mesh(), std::array{MeshEntry{}}, file.materials);
}

Camera room_camera(const RoomEntry& room) {
  const auto at = [&room](const Vec3d& share) {
    return Vec3d{room.corner[0] + share[0] * room.size[0], room.corner[1] + share[1] * room.size[1],
                 room.corner[2] + share[2] * room.size[2]};
  };
  Camera camera;
  camera.eye = at({0.5, 0.55, 0.98});
  camera.look_at = at({0.5, 0.45, 0});
  camera.field_of_view_degrees = 60;
  return camera;
}

namespace {

/// What a measured lamp adds to: its opening, where it hangs and how it shines.
struct HungMeasure {
  ShapeMesh opening;
  SceneLamp lamp;
};

/// Faces as its shape does; without one it is as large as its file says.
HungMeasure hung_measure(const LampEntry& entry, const MeasuredLamp& measured, const vec::Box& room) {
  std::optional<Shape> shape = entry.shape;
  Vec3d centre = entry.centre.value_or(Vec3d{0, 0, 0});
  Vec3d facing = entry.facing;
  if (entry.hung) {
    HungLamp at = *entry.hung;
    const bool sized = at.radius > 0 || at.size[0] > 0;
    if (!sized) at.radius = std::min(measured.length, measured.width) / 2;
    shape = hung(at, room, entry.place);
    if (!sized) {
      centre = std::get<Ring>(*shape).centre;
      facing = std::get<Ring>(*shape).normal;
      shape.reset();
    }
  }
  if (!shape) {
    const SceneLamp lamp = hung_lamp(measured, facing, entry.along);
    return {opening_of(measured, lamp, centre, 1), lamp};
  }
  if (const auto* quad = std::get_if<Quad>(&*shape)) {
    const auto& corner = quad->corners;
    facing = vec::cross(vec::subtract(corner[1], corner[0]), vec::subtract(corner[3], corner[0]));
  } else {
    facing = std::get<Ring>(*shape).normal;
  }
  return {tessellated(*shape, ShapeCollector::exactly(24)), hung_lamp(measured, facing, entry.along)};
}

void add_measured_lamp(const LampEntry& entry, const MeasuredLamp& measured, const vec::Box& room,
                       SceneBuilder& builder) {
  const HungMeasure made = hung_measure(entry, measured, room);
  SceneMaterial material;
  material.name = *entry.ies;
  const double watts = entry.lumen ? *entry.lumen / kLumenPerWatt : measured.flux[0] + measured.flux[1];
  material.emission = vec::scale(entry.colour, watts / (std::numbers::pi * made.opening.area()));
  material.lamp = builder.add_lamp(measured.web, made.lamp);
  builder.add_shape(made.opening, material, entry.place);
}

}  // namespace

void add_lamps(const SceneFile& file, const std::filesystem::path& folder, SceneFiles& files, SceneBuilder& builder,
               Notices& notices) {
  vec::Box room = builder.bounds();
  if (file.room) {
    room = {file.room->corner, vec::add(file.room->corner, file.room->size)};
  }
  for (std::size_t i = 0; i < file.lamps.size(); ++i) {
    const LampEntry& lamp = file.lamps[i];
    if (lamp.hung && !(vec::largest(room.extent()) > 0))
      refuse(lamp.place, "[[lamp]] with 'at' needs a [room], or something else to hang in");
    if (lamp.ies) {
      const std::array<std::filesystem::path, 1> folders{folder};
      add_measured_lamp(lamp, load_measured_lamp(*lamp.ies, folders, files, lamp.place, notices), room, builder);
      continue;
    }
    const Shape shape = lamp.hung ? hung(*lamp.hung, room, lamp.place) : *lamp.shape;
    const ShapeMesh surface = tessellated(shape, ShapeCollector::exactly(24));
    SceneMaterial material;
    material.name = "lamp " + std::to_string(i + 1);
    material.emission = lamp.radiance.value_or(Vec3d{1, 1, 1});
    for (std::size_t c = 0; c < 3; ++c) material.emission[c] *= lamp.colour[c];
    // Flux is pi times radiance times area, of the triangles.
    if (lamp.lumen)
      material.emission = vec::scale(lamp.colour, *lamp.lumen / (kLumenPerWatt * std::numbers::pi * surface.area()));
    builder.add_shape(surface, material, lamp.place);
  }
}

}  // namespace torolux
