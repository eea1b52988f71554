// SPDX-License-Identifier: MIT
// Finds a camera by its name, or takes the first.
#include "host_tools/scene/choose_camera.hpp"

#include <algorithm>

#include "emulator/nearest_name.hpp"
#include "host_tools/scene/camera.hpp"
#include "host_tools/scene/mesh_transform.hpp"
#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

std::string names_of(const std::vector<ImportedCamera>& cameras) {
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0; i < cameras.size() && i < most; ++i)
    text += (i > 0 ? ", " : "") + in_quotes(cameras[i].names[0]);
  if (cameras.size() > most) text += " and " + std::to_string(cameras.size() - most) + " more";
  return text;
}

const ImportedCamera& named(const std::vector<ImportedCamera>& cameras, const std::string& name, const Place& scene) {
  const auto has_name = [&name](const ImportedCamera& one) {
    return std::ranges::find(one.names, name) != one.names.end();
  };
  const auto found = std::ranges::find_if(cameras, has_name);
  if (found != cameras.end()) return *found;
  if (cameras.empty())
    refuse(scene, "--camera " + in_quotes(name) + ": its meshes have no cameras; --eye and --look-at place one");
  std::vector<std::string> known;
  for (const ImportedCamera& one : cameras) known.insert(known.end(), one.names.begin(), one.names.end());
  refuse(scene,
         "no camera is called " + in_quotes(name) + did_you_mean(name, known) + " There are " + names_of(cameras));
}

}  // namespace

void add_cameras(const ImportedMesh& mesh, const MeshEntry& entry, std::vector<ImportedCamera>& cameras) {
  const MeshTransform transform(entry);
  for (ImportedCamera one : mesh.cameras) {
    one.camera.eye = transform.position(one.camera.eye);
    one.camera.look_at = transform.position(one.camera.look_at);
    one.camera.up = transform.direction(one.camera.up);
    cameras.push_back(std::move(one));
  }
}

std::optional<Camera> choose_camera(const std::vector<ImportedCamera>& cameras, const std::string& name,
                                    const std::optional<Camera>& own, const Place& scene, Notices& notices) {
  if (name.empty() && (own || cameras.empty())) return own;
  const ImportedCamera& chosen = name.empty() ? cameras.front() : named(cameras, name, scene);
  if (name.empty() && cameras.size() > 1)
    notices.note("the first of " + std::to_string(cameras.size()) + " cameras is taken; --camera NAME takes one of " +
                     names_of(cameras),
                 chosen.place);
  if (const auto fault = camera_fault(chosen.camera)) refuse(chosen.place, *fault);
  return chosen.camera;
}

}  // namespace torolux
