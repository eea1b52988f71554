// SPDX-License-Identifier: MIT
// Checks cameras; places one in front of a scene.
#include "host_tools/scene/camera.hpp"

#include <cmath>
#include <numbers>

namespace torolux {

double focus_distance(const Camera& camera) {
  const Vec3d view = vec::subtract(camera.look_at, camera.eye);
  if (!camera.focus) return vec::length(view);
  if (const auto* distance = std::get_if<double>(&*camera.focus)) return *distance;
  return vec::dot(vec::subtract(std::get<Vec3d>(*camera.focus), camera.eye), vec::unit(view));
}

std::optional<std::string> camera_fault(const Camera& camera) {
  for (const Vec3d* v : {&camera.eye, &camera.look_at, &camera.up})
    for (const double x : *v)
      if (!std::isfinite(x)) return "has a coordinate that is not a finite number";
  const double fov = camera.field_of_view_degrees;
  if (!(fov > 0 && fov < 180))
    return "has a vertical field of view of " + std::to_string(fov) + " degrees; it must lie between 0 and 180";
  const Vec3d view = vec::subtract(camera.look_at, camera.eye);
  if (!(vec::length(view) > 0)) return "looks nowhere: the eye and the point it looks at are the same";
  if (!(vec::length(camera.up) > 0)) return "has no up: its length is zero";
  if (vec::length(vec::cross(vec::unit(view), vec::unit(camera.up))) < 1e-6)
    return "looks along its own up direction; choose another up, such as 0,0,1";
  if (!(camera.aperture >= 0 && std::isfinite(camera.aperture)))
    return "has an aperture of " + std::to_string(camera.aperture) + "; it must not be negative, 0 is no lens";
  if (camera.aperture > 0 && !(focus_distance(camera) > 1e-6 * camera.aperture))
    return "is focused on what does not lie before it; focus is a distance above 0, or a point that it sees";
  return std::nullopt;
}

Camera front_camera(const vec::Box& box) {
  Camera camera;
  camera.look_at = box.centre();
  const Vec3d extent = box.extent();
  const double half = 0.5 * std::max(extent[0], extent[1]);
  const double reach = 1.02 * std::max(half, 0.25 * extent[2]);
  const double distance = reach / std::tan(camera.field_of_view_degrees * std::numbers::pi / 360);
  camera.eye = camera.look_at;
  camera.eye[2] = box.high[2] + distance;
  return camera;
}

}  // namespace torolux
