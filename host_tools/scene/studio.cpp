// SPDX-License-Identifier: MIT
// Builds the studio: six walls that face inwards and a lamp under the ceiling that faces down.
#include "host_tools/scene/studio.hpp"

#include <numbers>

namespace torolux {
namespace {

const Place kPlace{"--studio", 0};

SceneMaterial diffuse(const char* name, const Vec3d& reflectance) {
  SceneMaterial material;
  material.name = name;
  material.diffuse = reflectance;
  return material;
}

Camera studio_camera(const vec::Box& mesh) {
  Camera camera;
  camera.look_at = mesh.centre();
  const double radius = 0.5 * vec::length(mesh.extent());
  const double distance = 1.05 * radius / std::sin(camera.field_of_view_degrees * std::numbers::pi / 360);
  camera.eye = vec::add(camera.look_at, vec::scale(vec::unit({0.3, 0.25, 1}), distance));
  return camera;
}

/// A face of the room's box, front inwards: axis 0..2, at the upper or lower end.
std::array<Vec3d, 4> wall(const vec::Box& room, std::size_t axis, bool upper) {
  const std::size_t u = (axis + 1) % 3;
  const std::size_t v = (axis + 2) % 3;
  std::array<Vec3d, 4> corners;
  constexpr std::array<std::array<bool, 2>, 4> around{{{false, false}, {true, false}, {true, true}, {false, true}}};
  for (std::size_t i = 0; i < 4; ++i) {
    const auto& [at_u, at_v] = around[upper ? 3 - i : i];
    corners[i][axis] = upper ? room.high[axis] : room.low[axis];
    corners[i][u] = at_u ? room.high[u] : room.low[u];
    corners[i][v] = at_v ? room.high[v] : room.low[v];
  }
  return corners;
}

vec::Box fitted_room(const vec::Box& mesh, const Camera& camera) {
  const double size = vec::largest(mesh.extent());
  vec::Box room = mesh;
  room.include(camera.eye);
  for (const std::size_t axis : {std::size_t{0}, std::size_t{2}}) {
    room.low[axis] = std::min(room.low[axis] - 0.3 * size, mesh.low[axis] - 1.2 * size);
    room.high[axis] = std::max(room.high[axis] + 0.3 * size, mesh.high[axis] + 1.2 * size);
  }
  room.high[1] = std::max(room.high[1] + 0.3 * size, mesh.high[1] + 1.0 * size);
  // A hair below the mesh, so that a floor of its own does not coincide with the room's.
  room.low[1] = std::min(mesh.low[1] - 1e-3 * size, camera.eye[1] - 0.3 * size);
  if (camera.eye[1] > mesh.low[1]) room.low[1] = mesh.low[1] - 1e-3 * size;
  return room;
}

}  // namespace

void add_studio(SceneBuilder& builder, std::optional<Camera>& camera) {
  const vec::Box mesh = builder.bounds();
  const double size = vec::largest(mesh.extent());
  if (!(size > 0)) return;
  if (!camera) camera = studio_camera(mesh);
  const vec::Box room = fitted_room(mesh, *camera);
  const SceneMaterial white = diffuse("studio white", {0.75, 0.74, 0.72});
  builder.add_rectangle(wall(room, 0, false), diffuse("studio warm", {0.74, 0.62, 0.52}), kPlace);
  builder.add_rectangle(wall(room, 0, true), diffuse("studio cool", {0.52, 0.62, 0.72}), kPlace);
  for (const std::size_t axis : {std::size_t{1}, std::size_t{2}})
    for (const bool upper : {false, true}) builder.add_rectangle(wall(room, axis, upper), white, kPlace);

  const Vec3d centre = mesh.centre();
  const double lamp_y = room.high[1] - 0.01 * (room.high[1] - room.low[1]);
  const double half_x = 0.6 * size;
  const double half_z = std::max(0.6 * size, 0.3 * (room.high[2] - room.low[2]));
  // As bright as gives a white floor under it a radiance of about 0.5.
  const double height = room.high[1] - room.low[1];
  const double radiance = 1.0 + height * height / (4 * half_x * half_z) * 0.8;
  SceneMaterial lamp = diffuse("studio lamp", {0, 0, 0});
  lamp.emission = vec::scale({1.0, 0.95, 0.88}, radiance);
  const double mid_z = std::clamp(centre[2], room.low[2] + half_z, room.high[2] - half_z);
  builder.add_rectangle({{{centre[0] - half_x, lamp_y, mid_z - half_z},
                          {centre[0] + half_x, lamp_y, mid_z - half_z},
                          {centre[0] + half_x, lamp_y, mid_z + half_z},
                          {centre[0] - half_x, lamp_y, mid_z + half_z}}},
                        lamp, kPlace);
}

}  // namespace torolux
