// SPDX-License-Identifier: MIT
// Puts the parts of the import together: scene.toml, meshes, studio, checks.
#include "host_tools/scene/load_scene.hpp"

#include <algorithm>

#include "emulator/errors.hpp"
#include "emulator/nearest_name.hpp"
#include "host_tools/scene/build_scene.hpp"
#include "host_tools/scene/camera.hpp"
#include "host_tools/scene/choose_camera.hpp"
#include "host_tools/scene/decide_panes.hpp"
#include "host_tools/scene/gltf.hpp"
#include "host_tools/scene/keep_on.hpp"
#include "host_tools/scene/mesh_transform.hpp"
#include "host_tools/scene/mgf.hpp"
#include "host_tools/scene/obj.hpp"
#include "host_tools/scene/part_overlaps.hpp"
#include "host_tools/scene/plain_text.hpp"
#include "host_tools/scene/scene_file.hpp"
#include "host_tools/scene/scene_shapes.hpp"
#include "host_tools/scene/sky.hpp"
#include "host_tools/scene/statements.hpp"
#include "host_tools/scene/studio.hpp"

namespace torolux {
namespace {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

constexpr const char* kAllowed = "a scene is a folder with scene.toml, a .toml, an .obj, a .gltf, a .glb or an .mgf";

bool is_mesh(const std::filesystem::path& path) {
  const std::string extension = lower_extension(path);
  return extension == ".obj" || extension == ".gltf" || extension == ".glb" || extension == ".mgf";
}

ImportedMesh import_mesh(const std::filesystem::path& path, SceneFiles& files, const Place& asked_at,
                         const SceneOptions& options, Notices& notices) {
  const std::string extension = lower_extension(path);
  if (extension == ".obj") return import_obj(path, files, asked_at, notices);
  if (extension == ".mgf") return import_mgf(path, files, asked_at, notices);
  return import_gltf(path, files, asked_at, options.gltf_units, notices);
}

/// The .toml or mesh that is meant.
std::filesystem::path scene_path(const std::filesystem::path& path, SceneFiles& files) {
  std::error_code error;
  if (path.empty()) refuse({}, std::string("no scene is named; ") + kAllowed);
  if (!std::filesystem::is_directory(path, error)) return path;
  std::filesystem::path inside = path / "scene.toml";
  if (files.exists(inside)) return inside;
  std::vector<std::string> meshes;
  for (const auto& entry : std::filesystem::directory_iterator(path, error))
    if (is_mesh(entry.path())) meshes.push_back(entry.path().filename().string());
  std::sort(meshes.begin(), meshes.end());
  std::string hint = std::string("; ") + kAllowed;
  if (!meshes.empty()) hint = "; name one of its meshes:";
  for (const std::string& mesh : meshes) hint += " " + (path / mesh).string();
  refuse({path.string()}, "there is no scene.toml in this folder" + hint);
}

SceneFile scene_file_for_mesh(const std::filesystem::path& path) {
  SceneFile file;
  file.meshes.push_back({path.filename().string(), {MeshEntry{}}, {}});
  return file;
}

std::string scene_name(const std::filesystem::path& path) {
  if (path.filename() != "scene.toml") return path.stem().string();
  return std::filesystem::absolute(path).lexically_normal().parent_path().filename().string();
}

/// What meshes bring along.
struct Brought {
  std::vector<ImportedCamera> cameras;
  std::vector<ImportedSun> suns;
};

Brought add_meshes(const SceneFile& file, const std::filesystem::path& scene, SceneFiles& files,
                   const SceneOptions& options, SceneBuilder& builder, Notices& notices) {
  Brought brought;
  for (const MeshFile& named : file.meshes) {
    const std::filesystem::path mesh = scene.parent_path() / named.file;
    const Place asked_at = named.place.file.empty() ? Place{scene.string(), 0} : named.place;
    if (!is_mesh(mesh))
      refuse(asked_at, "'" + named.file + "' is not an .obj, .gltf, .glb or .mgf; no other mesh is read");
    const ImportedMesh imported = import_mesh(mesh, files, asked_at, options, notices);
    builder.add_mesh(imported, named.instances, file.materials);
    for (const MeshEntry& entry : named.instances) {
      add_cameras(imported, entry, brought.cameras);
      for (ImportedSun sun : imported.suns) {
        sun.direction = MeshTransform(entry).direction(sun.direction);
        brought.suns.push_back(std::move(sun));
      }
    }
  }
  return brought;
}

void add_lights(const SceneFile& file, SceneBuilder& builder) {
  for (std::size_t i = 0; i < file.lights.size(); ++i) {
    SceneMaterial material;
    material.name = "light " + std::to_string(i + 1);
    material.emission = file.lights[i].radiance;
    material.diffuse = file.lights[i].diffuse;
    builder.add_rectangle(file.lights[i].corners, material, file.lights[i].place);
  }
}

void note_unused_overrides(const SceneFile& file, const std::vector<std::string>& used, Notices& notices) {
  for (const MaterialOverride& material : file.materials)
    if (std::find(used.begin(), used.end(), material.name) == used.end())
      notices.note("no face uses material '" + material.name + "'", material.place);
}

}  // namespace

Scene load_scene(const std::filesystem::path& path, const SceneOptions& options) {
  DiskFiles files;
  return load_scene_from(files, path, options);
}

Scene load_scene_from(SceneFiles& files, const std::filesystem::path& named, const SceneOptions& options) {
  const std::filesystem::path path = scene_path(named, files);
  if (!files.exists(path)) {
    const std::string near = nearest_name(path.filename().string(), files.names_in(path.parent_path()));
    refuse({}, "there is no scene '" + path.string() + "'" +
                   (near.empty() ? "" : "; did you mean " + in_quotes((path.parent_path() / near).string()) + "?") +
                   "; " + kAllowed);
  }
  const std::string extension = lower_extension(path);
  if (extension != ".toml" && !is_mesh(path))
    refuse({path.string()}, "'" + extension + "' is not a kind of scene that is read; " + kAllowed);
  const Place whole{path.string(), 0};
  Notices notices;
  const std::string text =
      is_mesh(path) ? "" : plain_text(files.read(path, whole, kMostTextBytes), path.string(), notices);
  const SceneFile file = is_mesh(path) ? scene_file_for_mesh(path) : read_scene_file(text, path.string());
  if (file.meshes.empty() && file.lights.empty() && file.shapes.empty() && file.lamps.empty() && !file.room)
    refuse(whole, "no [[mesh]], [room] or shape is named: there is nothing to render");

  SceneBuilder builder(files, options.missing_materials, notices);
  const Brought brought = add_meshes(file, path, files, options, builder, notices);
  add_shapes(file, whole, builder);
  add_lights(file, builder);
  add_lamps(file, path.parent_path(), files, builder, notices);

  Scene scene;
  scene.name = file.name.value_or(scene_name(path));
  scene.defaults = file.defaults;
  scene.sky = file.sky;
  if (file.sky_image) scene.sky->radiance = load_sky_image(*file.sky_image, path.parent_path(), files, notices);
  take_suns(brought.suns, scene.sky, notices);
  scene.camera = choose_camera(brought.cameras, options.camera_name, file.camera, whole, notices);
  const vec::Box bounds = builder.bounds();
  if (options.studio) {
    if (!builder.has_surface()) refuse(whole, "no surface with an area: there is nothing to put into the studio");
    if (options.camera) scene.camera = options.camera;
    add_studio(builder, scene.camera);
  }
  builder.finish(scene, whole);
  look_for_interruption();
  decide_panes(scene, notices, whole);
  look_for_interruption();
  part_overlaps(scene, notices, whole);
  std::vector<std::string> used;
  for (const SceneMaterial& material : scene.materials) used.push_back(material.name);
  note_unused_overrides(file, used, notices);
  scene.warnings = notices.lines();
  if (!scene.camera && options.camera) scene.camera = options.camera;
  if (!scene.camera && file.room && !file.room->open[static_cast<std::size_t>(Wall::front)]) {
    scene.camera = room_camera(*file.room);
    scene.warnings.push_back(path.string() + ": names no camera: one stands at the room's front wall");
  }
  if (!scene.camera) {
    scene.camera = front_camera(bounds);
    scene.warnings.push_back(path.string() + ": names no camera: one looks from the front, along -z");
  }
  if (options.strict) refuse_what_is_told(scene.warnings);
  return scene;
}

void refuse_what_is_told(const std::vector<std::string>& told) {
  if (told.empty()) return;
  std::string text = "refused by --strict:";
  for (const std::string& line : told) text += "\n  " + line;
  throw InputError(text);
}

void check_renderable(const Scene& scene) {
  const bool lit =
      scene.sky || std::any_of(scene.triangles.begin(), scene.triangles.end(), [&scene](const SceneTriangle& triangle) {
        return vec::largest(scene.materials[triangle.material].emission) > 0;
      });
  if (!lit) {
    std::string why =
        "scene '" + scene.name +
        "' has no light: no face emits. Give a material Ke, add a [[light]] or a [sky] to scene.toml, or use "
        "--studio for a room with a lamp";
    for (const std::string& line : scene.warnings) why += "\n  " + line;
    throw InputError(why);
  }
  if (scene.camera) check_camera(*scene.camera);
}

void check_camera(const Camera& camera) {
  if (const auto fault = camera_fault(camera)) throw InputError("the camera " + *fault);
}

}  // namespace torolux
