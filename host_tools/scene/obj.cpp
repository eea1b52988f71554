// SPDX-License-Identifier: MIT
// Joins the check, the material libraries, tinyobjloader's faces and their triangles into a mesh.
#include "host_tools/scene/obj.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <sstream>
#include <unordered_map>

#include "host_tools/scene/find_file.hpp"
#include "host_tools/scene/keep_on.hpp"
#include "host_tools/scene/mtl.hpp"
#include "host_tools/scene/obj_check.hpp"
#include "host_tools/scene/plain_text.hpp"
#include "host_tools/scene/polygon_triangles.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/tinyobj.hpp"

namespace torolux {
namespace {

constexpr const char* kNoMaterialName = "(none)";
constexpr const char* kNoNameGiven = "(no name)";

/// Receives tinyobjloader's calls in the order of the file.
class MeshBuilder {
 public:
  MeshBuilder(ImportedMesh& mesh, const CheckedObj& checked, std::vector<std::uint32_t> material_of_use,
              Notices& notices)
      : mesh_(mesh), checked_(checked), material_of_use_(std::move(material_of_use)), notices_(notices) {}

  void use(const std::string& number) { material_ = material_of_use_.at(std::stoul(number)); }

  void face(std::span<const tinyobj::index_t> indices) {
    look_for_interruption(faces_);
    const Place place{mesh_.file, checked_.face_lines.at(faces_++)};
    corners_.clear();
    points_.clear();
    for (const tinyobj::index_t& index : indices) {
      const Corner corner{usable_position(static_cast<std::uint32_t>(index.vertex_index - 1)),
                          usable(index.normal_index, mesh_.normals),
                          usable(index.texcoord_index, mesh_.texture_points)};
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

  std::uint32_t usable_position(std::uint32_t index) const {
    const auto found = checked_.unusable_positions.find(index);
    if (found != checked_.unusable_positions.end()) refuse(found->second.place, found->second.message);
    return index;
  }

  /// index: from 1; 0: none is named.
  static std::uint32_t usable(int index, const auto& values) {
    if (index <= 0) return kNoNormal;
    const auto at = static_cast<std::size_t>(index - 1);
    return at < values.size() && std::isfinite(values[at][0]) ? static_cast<std::uint32_t>(at) : kUnusable;
  }

  void add(const std::array<std::uint32_t, 3>& triangle, const Place& place) {
    ImportedTriangle out{{}, {}, material(place), static_cast<std::uint32_t>(place.line)};
    for (std::size_t i = 0; i < 3; ++i) {
      out.position[i] = corners_[triangle[i]].position;
      out.normal[i] = corners_[triangle[i]].normal;
      out.texture_point[i] = corners_[triangle[i]].texture_point;
    }
    for (auto* indices : {&out.normal, &out.texture_point})
      for (const std::uint32_t none : {kNoNormal, kUnusable})
        if (std::ranges::find(*indices, none) != indices->end()) indices->fill(none);
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

/// Reads the libraries of a mesh, each once.
class LibraryReader {
 public:
  LibraryReader(const std::filesystem::path& folder, SceneFiles& files, ImportedMesh& mesh, Notices& notices)
      : folders_{folder}, files_(files), mesh_(mesh), notices_(notices) {}

  /// One name that may hold spaces, or several names.
  void read(const NameUse& use) {
    const std::vector<std::string> several = names_in(use.name);
    const auto there = [&](const std::string& name) {
      const auto found = find(name, use.place);
      return found && found->as_written;
    };
    if (several.size() == 1 || there(use.name)) return import(use.name, use.place);
    if (!std::ranges::all_of(several, there) && find(use.name, use.place)) return import(use.name, use.place);
    for (const std::string& name : several) import(name, use.place);
  }

 private:
  /// Separated by blanks, unless quotation marks hold them together.
  static std::vector<std::string> names_in(const std::string& text) {
    std::vector<std::string> names(1);
    char quote = 0;
    for (const char c : text) {
      if (quote == 0 && (c == ' ' || c == '\t')) {
        if (!names.back().empty()) names.emplace_back();
        continue;
      }
      names.back().push_back(c);
      if (c == quote)
        quote = 0;
      else if (c == '"' && names.back().size() == 1)
        quote = c;
    }
    return names;
  }

  std::optional<FoundFile> find(const std::string& name, const Place& place) {
    return find_file(name, folders_, files_, place);
  }

  void import(const std::string& name, const Place& place) {
    const auto found = find(name, place);
    if (!found) {
      notices_.note("there is no material library " + in_quotes(name), place);
      mesh_.missing_libraries.emplace_back(name, place);
      return;
    }
    const std::string path = found->path.string();
    if (std::ranges::find(done_, path) != done_.end()) return;
    done_.push_back(path);
    if (!found->as_written)
      notices_.note("a material library is found under another name", place,
                    in_quotes(name) + " is " + in_quotes(path));
    import_mtl(plain_text(files_.read(path, place, kMostTextBytes), path, notices_), path, folders_[0], mesh_.materials,
               notices_);
  }

  std::array<std::filesystem::path, 1> folders_;
  SceneFiles& files_;
  ImportedMesh& mesh_;
  Notices& notices_;
  std::vector<std::string> done_;
};

/// Materials by what a usemtl may have meant.
class MaterialNames {
 public:
  explicit MaterialNames(const std::vector<ImportedMaterial>& materials) {
    for (std::size_t i = 0; i < materials.size(); ++i) {
      exact_.emplace(materials[i].material.name, i);
      for (const std::string& reading : other_readings(materials[i].material.name)) readings_.emplace(reading, i);
      const auto [entry, fresh] = in_lower_case_.emplace(lower(materials[i].material.name), i);
      if (!fresh) entry->second = kSeveral;
    }
  }

  /// The material, and whether it has this very name.
  std::optional<std::pair<std::size_t, bool>> find(const std::string& name) const {
    if (const auto found = exact_.find(name); found != exact_.end()) return std::pair(found->second, true);
    for (const std::string& reading : other_readings(name))
      if (const auto found = exact_.find(reading); found != exact_.end()) return std::pair(found->second, false);
    if (const auto found = readings_.find(name); found != readings_.end()) return std::pair(found->second, false);
    const auto alike = in_lower_case_.find(lower(name));
    if (alike == in_lower_case_.end() || alike->second == kSeveral) return std::nullopt;
    return std::pair(alike->second, false);
  }

 private:
  static constexpr std::size_t kSeveral = ~std::size_t{0};
  static std::string lower(std::string text) {
    for (char& c : text)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
  }
  std::unordered_map<std::string, std::size_t> exact_, readings_, in_lower_case_;
};

/// Where each use's material stands in the mesh; unknown ones are added as not defined, and that without a name as
/// white, which the format has it be.
std::vector<std::uint32_t> resolve_uses(const CheckedObj& checked, ImportedMesh& mesh, Notices& notices) {
  const MaterialNames names(mesh.materials);
  std::vector<std::uint32_t> material_of_use;
  for (const NameUse& use : checked.materials) {
    if (const auto found = names.find(use.name)) {
      const auto& [number, exact] = *found;
      if (!exact)
        notices.note("a material is found under another name", use.place,
                     in_quotes(use.name) + " is " + in_quotes(mesh.materials[number].material.name));
      material_of_use.push_back(static_cast<std::uint32_t>(number));
      continue;
    }
    material_of_use.push_back(static_cast<std::uint32_t>(mesh.materials.size()));
    if (use.name.empty()) {
      notices.note("usemtl without a name: white, diffuse with reflectance 0.99; scene.toml calls it '(no name)'",
                   use.place);
      mesh.materials.push_back({white_material(kNoNameGiven), true, use.place});
    } else {
      SceneMaterial unknown;
      unknown.name = use.name;
      mesh.materials.push_back({unknown, false, use.place});
    }
  }
  return material_of_use;
}

}  // namespace

ImportedMesh import_obj(const std::filesystem::path& path, SceneFiles& files, const Place& asked_at, Notices& notices) {
  ImportedMesh mesh;
  mesh.file = path.string();
  CheckedObj checked =
      check_obj(plain_text(files.read(path, asked_at, kMostMeshBytes), mesh.file, notices), mesh.file, notices);
  mesh.positions = std::move(checked.positions);
  mesh.normals = std::move(checked.normals);
  mesh.texture_points = std::move(checked.texture_points);
  LibraryReader libraries(path.parent_path(), files, mesh, notices);
  for (const NameUse& library : checked.libraries) libraries.read(library);

  MeshBuilder builder(mesh, checked, resolve_uses(checked, mesh, notices), notices);
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
