// SPDX-License-Identifier: MIT
// Walks the nodes of a glTF scene and gathers what they carry: meshes, lights, cameras.
#include "host_tools/scene/gltf.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "host_tools/scene/gltf_lights.hpp"
#include "host_tools/scene/gltf_materials.hpp"
#include "host_tools/scene/gltf_nodes.hpp"
#include "host_tools/scene/gltf_surfaces.hpp"
#include "host_tools/scene/keep_on.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

class Importer {
 public:
  Importer(const GltfDocument& document, SceneFiles& files, GltfUnits units, Notices& notices)
      : document_(document),
        root_(document.root()),
        data_(document, files, notices),
        materials_(root_, data_, files, units, notices),
        units_(units),
        notices_(notices),
        accessors_(root_.count("accessors")) {
    mesh_.file = document.file;
  }

  ImportedMesh run() {
    if (root_.count("animations") > 0) notices_.note("animations are not played", root_.place());
    for (const PlacedNode& placed : placed_nodes(document_, notices_)) {
      look_for_interruption();
      const GltfObject node = root_.element("nodes", placed.number, "node");
      if (const auto mesh = node.index("mesh", root_.count("meshes"), "meshes")) add_meshes(node, *mesh, placed.place);
      if (const auto camera = node.index("camera", root_.count("cameras"), "cameras"))
        add_camera(node, *camera, placed.place);
      add_light(node, placed.place);
    }
    add_lights();
    tell_units();
    return std::move(mesh_);
  }

 private:
  /// A primitive with what of it is the same wherever it stands.
  struct Held {
    GltfSurface surface;
    std::uint32_t material;
    std::uint32_t part;
    std::uint32_t first_texture_point;
  };

  void add_meshes(const GltfObject& node, std::size_t number, const Affine& place) {
    if (node.has("skin")) notices_.note("a skin is not applied: its mesh is rendered at rest", node.place());
    const std::vector<Held>& held = surfaces_of(number);
    for (const Affine& one : instances(node, place, data_, accessors_))
      for (const Held& surface : held) add(surface, one, node);
  }

  const std::vector<Held>& surfaces_of(std::size_t number) {
    const auto [entry, fresh] = surfaces_.try_emplace(number);
    if (!fresh) return entry->second;
    const GltfObject mesh = root_.element("meshes", number, "mesh");
    for (std::size_t i = 0; i < mesh.count("primitives"); ++i) {
      const GltfObject primitive = mesh.element("primitives", i, "primitive");
      const auto material = primitive.index("material", root_.count("materials"), "materials");
      const auto& [read, place] = material_of(material);
      if (read.invisible) {
        notices_.note("what its material's alpha leaves nothing of is not there", primitive.place());
        continue;
      }
      Held held{read_gltf_surface(primitive, accessors_, read.mapping, data_, notices_), place,
                static_cast<std::uint32_t>(mesh_.parts.size()),
                static_cast<std::uint32_t>(mesh_.texture_points.size())};
      check_room(read_vertices_ += held.surface.positions.size(), primitive.place());
      if (held.surface.triangles.empty()) continue;
      mesh_.parts.push_back(primitive.place().file);
      check_room(mesh_.texture_points.size() + held.surface.texture_points.size(), primitive.place());
      mesh_.texture_points.insert(mesh_.texture_points.end(), held.surface.texture_points.begin(),
                                  held.surface.texture_points.end());
      entry->second.push_back(std::move(held));
    }
    return entry->second;
  }

  /// And its number in the mesh.
  const std::pair<GltfMaterial, std::uint32_t>& material_of(std::optional<std::size_t> number) {
    const auto [entry, fresh] = read_.try_emplace(number);
    if (!fresh) return entry->second;
    entry->second = {materials_.read(number), static_cast<std::uint32_t>(mesh_.materials.size())};
    mesh_.materials.push_back(entry->second.first.material);
    return entry->second;
  }

  static void check_room(std::size_t size, const Place& place) {
    if (size > kMostElements)
      refuse(place, "more than " + std::to_string(kMostElements) + " vertices; simplify the mesh or leave parts out");
  }

  void add(const Held& held, const Affine& place, const GltfObject& node) {
    const GltfSurface& surface = held.surface;
    if (mesh_.triangles.size() + surface.triangles.size() > kMostTriangles)
      refuse(node.place(),
             "more than " + std::to_string(kMostTriangles) + " triangles; simplify the mesh or leave parts out");
    check_room(mesh_.positions.size() + surface.positions.size(), node.place());
    check_room(mesh_.normals.size() + surface.normals.size(), node.place());
    const auto first_position = static_cast<std::uint32_t>(mesh_.positions.size());
    const auto first_normal = static_cast<std::uint32_t>(mesh_.normals.size());
    for (const Vec3d& p : surface.positions) {
      const Vec3d position = place.point(p);
      // Vertices that no triangle uses may be anywhere.
      mesh_.positions.push_back(is_placeable(position) ? position : Vec3d{0, 0, 0});
    }
    for (const Vec3d& n : surface.normals) mesh_.normals.push_back(place.normal(n));
    const bool mirrors = place.determinant() < 0;
    for (std::array<std::uint32_t, 3> corners : surface.triangles) {
      for (const std::uint32_t corner : corners)
        if (!is_placeable(place.point(surface.positions[corner])))
          refuse(node.place(), "moves its mesh beyond 1e15 in magnitude");
      // A node that mirrors does not turn fronts into backs (glTF 2.0, 3.7.4).
      if (mirrors) std::swap(corners[1], corners[2]);
      add_triangle(held, corners, first_position, first_normal);
    }
  }

  static bool is_placeable(const Vec3d& position) {
    return std::ranges::all_of(position, [](double x) { return std::abs(x) <= kMostCoordinate; });
  }

  void add_triangle(const Held& held, const std::array<std::uint32_t, 3>& corners, std::uint32_t first_position,
                    std::uint32_t first_normal) {
    ImportedTriangle triangle{{}, {}, held.material, held.part};
    for (std::size_t i = 0; i < 3; ++i) {
      triangle.position[i] = first_position + corners[i];
      triangle.normal[i] = usable(corners[i], held.surface.normals, first_normal);
      triangle.texture_point[i] = usable(corners[i], held.surface.texture_points, held.first_texture_point);
    }
    for (auto* indices : {&triangle.normal, &triangle.texture_point})
      for (const std::uint32_t none : {kNoNormal, kUnusable})
        if (std::ranges::find(*indices, none) != indices->end()) indices->fill(none);
    mesh_.triangles.push_back(triangle);
  }

  /// Where the mesh has a vertex's value, of those that a primitive has for each of its vertices, or not at all.
  static std::uint32_t usable(std::uint32_t vertex, const auto& values, std::uint32_t first) {
    if (values.empty()) return kNoNormal;
    const auto finite = [](double x) { return std::isfinite(x); };
    return vertex < values.size() && std::ranges::all_of(values[vertex], finite) ? first + vertex : kUnusable;
  }

  void add_camera(const GltfObject& node, std::size_t number, const Affine& place) {
    const GltfObject object = root_.element("cameras", number, "camera");
    const std::string type = object.text("type").value_or("");
    if (type != "perspective") {
      notices_.note("a camera that is not a perspective one is passed over", object.place(), in_quotes(type));
      return;
    }
    const auto perspective = object.object("perspective");
    const auto angle = perspective ? perspective->number("yfov", 1e-4, std::numbers::pi - 1e-4) : std::nullopt;
    if (!angle) refuse(object.place(), "has no 'yfov'");
    ImportedCamera camera{{}, {}, object.place()};
    for (const GltfObject* named : {&node, &object})
      if (const auto name = named->text("name"); name && !name->empty()) camera.names.push_back(*name);
    if (camera.names.empty()) camera.names.push_back("camera " + std::to_string(number));
    if (!(vec::length(place.axes[2]) > 0)) refuse(node.place(), "its scale is zero: its camera looks nowhere");
    camera.camera.eye = place.origin;
    camera.camera.look_at = vec::subtract(place.origin, vec::unit(place.axes[2]));
    camera.camera.up = place.axes[1];
    camera.camera.field_of_view_degrees = *angle * 180 / std::numbers::pi;
    mesh_.cameras.push_back(std::move(camera));
  }

  void add_light(const GltfObject& node, const Affine& place) {
    const auto reference = node.extension("KHR_lights_punctual");
    if (!reference) return;
    const auto lights = root_.extension("KHR_lights_punctual");
    const auto number = reference->index("light", lights ? lights->count("lights") : 0, "lights");
    if (number) lights_.push_back({*number, place});
  }

  /// Their size is that of the scene without them.
  void add_lights() {
    vec::Box box;
    for (const ImportedTriangle& triangle : mesh_.triangles)
      for (const std::uint32_t p : triangle.position) box.include(mesh_.positions[p]);
    const double longest = mesh_.triangles.empty() ? 1 : vec::largest(box.extent());
    constexpr double share = 0.005;
    constexpr std::size_t corners = 12;
    if (!lights_.empty()) check_room(mesh_.positions.size() + corners * (lights_.size() - 1), root_.place());
    add_gltf_lights(root_, lights_, share * longest, units_, mesh_, notices_);
  }

  void tell_units() {
    if (!mesh_.suns.empty() ||
        std::ranges::any_of(mesh_.materials, [](const ImportedMaterial& one) { return emits(one.material); })) {
      notices_.note(units_ == GltfUnits::watt
                        ? "light is taken in watts: 1 cd/m^2 as 1 W/(m^2 sr), 1 cd as 1 W/sr; --gltf-units lumen "
                          "divides by 683 lm/W"
                        : "light is taken in lumens: 683 lm are 1 W; --gltf-units watt takes the numbers as they are",
                    root_.place());
    }
  }

  const GltfDocument& document_;
  GltfObject root_;
  GltfData data_;
  GltfMaterials materials_;
  GltfUnits units_;
  Notices& notices_;
  std::size_t accessors_;
  std::size_t read_vertices_ = 0;
  ImportedMesh mesh_;
  std::map<std::size_t, std::vector<Held>> surfaces_;  // by mesh
  std::map<std::optional<std::size_t>, std::pair<GltfMaterial, std::uint32_t>> read_;
  std::vector<GltfLight> lights_;
};

}  // namespace

ImportedMesh import_gltf(const std::filesystem::path& path, SceneFiles& files, const Place& asked_at, GltfUnits units,
                         Notices& notices) {
  const GltfDocument document = read_gltf_document(files.read(path, asked_at, kMostMeshBytes), path.string(), notices);
  return Importer(document, files, units, notices).run();
}

}  // namespace torolux
