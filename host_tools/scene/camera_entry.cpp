// SPDX-License-Identifier: MIT
// Keys of a camera, each within its range.
#include "host_tools/scene/camera_entry.hpp"

#include "host_tools/scene/camera.hpp"
#include "host_tools/scene/imported_mesh.hpp"

namespace torolux {

Camera read_camera(TomlTable& table, const std::string& title, const Camera& like) {
  constexpr double most = kMostCoordinate;
  Camera camera = like;
  camera.eye = table.required(table.triple("eye", -most, most, false), "eye");
  camera.look_at = table.required(table.triple("look_at", -most, most, false), "look_at");
  if (const auto up = table.triple("up", -most, most, false)) camera.up = *up;
  camera.field_of_view_degrees = table.number("fov", 0.01, 179).value_or(camera.field_of_view_degrees);
  camera.aperture = table.number("aperture", 0, most).value_or(camera.aperture);
  if (const auto focus = table.number_or_triple("focus", -most, most)) camera.focus = focus;
  if (const auto wrong = camera_fault(camera)) refuse(table.place(), title + " " + *wrong);
  return camera;
}

}  // namespace torolux
