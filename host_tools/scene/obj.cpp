// SPDX-License-Identifier: MIT
// Joins the check, the material libraries, tinyobjloader's faces and their triangles into a mesh.
#include "host_tools/scene/obj.hpp"

#include <sstream>

#include "emulator/errors.hpp"
#include "host_tools/scene/mtl.hpp"
#include "host_tools/scene/obj_check.hpp"
#include "host_tools/scene/polygon_triangles.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/tinyobj.hpp"

namespace torolux {
namespace {

constexpr const char* kNoMaterialName = "(none)";

/// Receives tinyobjloader's calls in the order of the file.
class MeshBuilder {
 public:
  MeshBuilder(ImportedMesh& mesh, const CheckedObj& checked, std::vector<std::uint32_t> material_of_use,
              Notices& notices)
      : mesh_(mesh), checked_(checked), material_of_use_(std::move(material_of_use)), notices_(notices) {}

  void use(const std::string& number) { material_ = material_of_use_.at(std::stoul(number)); }

  void face(std::span<const tinyobj::index_t> indices) {
    const Place place{mesh_.file, checked_.face_lines.at(faces_++)};
    corners_.clear();
    points_.clear();
    for (const tinyobj::index_t& index : indices) {
      const Corner corner{static_cast<std::uint32_t>(index.vertex_index - 1),
                          index.normal_index > 0 ? static_cast<std::uint32_t>(index.normal_index - 1) : kNoNormal,
                          index.texcoord_index > 0 ? static_cast<std::uint32_t>(index.texcoord_index - 1) : kNoNormal};
      const Vec3d& point = mesh_.positions.at(corner.position);
      if (!points_.empty() && (points_.back() == point)) continue;
      corners_.push_back(corner);
      points_.push_back(point);
    }
    while (points_.size() > 1 && points_.back() == points_.front()) {
      points_.pop_back();
      corners_.pop_back();
    }
    const PolygonTriangles cut = cut_polygon(points_);
    if (cut.triangles.empty()) notices_.note("a face without area is left out", place);
    if (cut.crosses_itself) notices_.note("a face crosses itself; its triangles may not cover what was meant", place);
    for (const auto& triangle : cut.triangles) add(triangle, place);
  }

 private:
  struct Corner {
    std::uint32_t position, normal, texture_point;
  };

  void add(const std::array<std::uint32_t, 3>& triangle, const Place& place) {
    ImportedTriangle out{{}, {}, material(place), static_cast<std::uint32_t>(place.line)};
    bool normals = true;
    bool texture_points = true;
    for (std::size_t i = 0; i < 3; ++i) {
      out.position[i] = corners_[triangle[i]].position;
      out.normal[i] = corners_[triangle[i]].normal;
      out.texture_point[i] = corners_[triangle[i]].texture_point;
      normals = normals && out.normal[i] != kNoNormal;
      texture_points = texture_points && out.texture_point[i] != kNoNormal;
    }
    if (!normals) out.normal.fill(kNoNormal);
    if (!texture_points) out.texture_point.fill(kNoNormal);
    mesh_.triangles.push_back(out);
  }

  std::uint32_t material(const Place& place) {
    if (material_ == kNone) {
      SceneMaterial grey;
      grey.name = kNoMaterialName;
      grey.diffuse = {0.7, 0.7, 0.7};
      notices_.note("faces before any usemtl are diffuse with reflectance 0.7; scene.toml can give them a material",
                    place);
      material_ = static_cast<std::uint32_t>(mesh_.materials.size());
      mesh_.materials.push_back({grey, true, place});
    }
    return material_;
  }

  static constexpr std::uint32_t kNone = 0xFFFF'FFFFU;
  ImportedMesh& mesh_;
  const CheckedObj& checked_;
  std::vector<std::uint32_t> material_of_use_;
  Notices& notices_;
  std::uint32_t material_ = kNone;
  std::size_t faces_ = 0;
  std::vector<Corner> corners_;
  std::vector<Vec3d> points_;
};

void import_libraries(const CheckedObj& checked, const std::filesystem::path& folder, SceneFiles& files,
                      ImportedMesh& mesh, Notices& notices) {
  std::vector<std::string> done;
  const auto import = [&](const std::string& name, const Place& place) {
    for (const std::string& other : done)
      if (other == name) return;
    done.push_back(name);
    const std::filesystem::path path = folder / name;
    if (!files.exists(path))
      refuse(place, "there is no material library '" + path.string() +
                        "'; put it there, or take the mtllib line out and give materials in scene.toml");
    import_mtl(files.read(path, place, kMostTextBytes), path.string(), mesh.materials, notices);
  };
  for (const NameUse& library : checked.libraries) {
    std::string name = library.name;
    for (char& c : name)
      if (c == '\\') c = '/';
    const Statement as_words{library.place.line, "mtllib " + name};
    const std::vector<std::string_view> words = as_words.arguments();
    if (words.size() == 1 || files.exists(folder / name))
      import(name, library.place);
    else
      for (const std::string_view word : words) import(std::string(word), library.place);
  }
}

/// Where each use's material stands in the mesh; unknown ones are added as not defined.
std::vector<std::uint32_t> resolve_uses(const CheckedObj& checked, ImportedMesh& mesh) {
  std::vector<std::uint32_t> material_of_use;
  for (const NameUse& use : checked.materials) {
    std::size_t found = 0;
    while (found < mesh.materials.size() && mesh.materials[found].material.name != use.name) ++found;
    if (found == mesh.materials.size()) {
      SceneMaterial unknown;
      unknown.name = use.name;
      mesh.materials.push_back({unknown, false, use.place});
    }
    material_of_use.push_back(static_cast<std::uint32_t>(found));
  }
  return material_of_use;
}

}  // namespace

ImportedMesh import_obj(const std::filesystem::path& path, SceneFiles& files, const Place& asked_at, Notices& notices) {
  ImportedMesh mesh;
  mesh.file = path.string();
  CheckedObj checked = check_obj(files.read(path, asked_at, kMostMeshBytes), mesh.file, notices);
  mesh.positions = std::move(checked.positions);
  mesh.normals = std::move(checked.normals);
  mesh.texture_points = std::move(checked.texture_points);
  import_libraries(checked, path.parent_path(), files, mesh, notices);

  MeshBuilder builder(mesh, checked, resolve_uses(checked, mesh), notices);
  tinyobj::callback_t callbacks;
  callbacks.index_cb = [](void* user, tinyobj::index_t* indices, int count) {
    static_cast<MeshBuilder*>(user)->face({indices, static_cast<std::size_t>(count)});
  };
  callbacks.usemtl_cb = [](void* user, const char* name, int) { static_cast<MeshBuilder*>(user)->use(name); };
  std::istringstream stream(std::move(checked.text));
  std::string warning;
  std::string error;
  if (!tinyobj::LoadObjWithCallback(stream, callbacks, &builder, nullptr, &warning, &error) || !error.empty())
    refuse({mesh.file}, "cannot be read: " + error);
  return mesh;
}

}  // namespace torolux
