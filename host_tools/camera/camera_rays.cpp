// SPDX-License-Identifier: MIT
// Checks the camera and makes the view's axes of it. A ray steps from cell to cell, from where it enters the grid to
// the first subspace that it may begin in.
#include "host_tools/camera/camera_rays.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "emulator/errors.hpp"
#include "firmware/protocol/first_cell.hpp"
#include "host_tools/scene/camera.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

CameraRays::CameraRays(const Camera& camera, const SceneSpace& space, std::uint32_t width, std::uint32_t height,
                       PixelSamples samples, std::uint32_t seed)
    : samples_(std::move(samples)), view_{} {
  const Vec3d view = vec::subtract(camera.look_at, camera.eye);
  const double view_length = vec::length(view);
  const double up_length = vec::length(camera.up);
  const Vec3d across = vec::cross(view, camera.up);
  if (!(view_length > 0) || !(vec::length(across) > 1e-9 * view_length * up_length) || !std::isfinite(view_length)) {
    throw InputError("the camera looks nowhere: eye and look-at must differ, and up must not lie along the view");
  }
  if (!(camera.field_of_view_degrees > 0 && camera.field_of_view_degrees < 180)) {
    throw InputError("the camera's field of view is " + std::to_string(camera.field_of_view_degrees) +
                     " degrees: more than 0 and less than 180 are allowed");
  }
  view_.eye = to_float(space.to_normalised(camera.eye));
  for (const float coordinate : view_.eye) {
    if (!(std::abs(coordinate) < 1e6F)) {
      throw InputError("the camera's eye is more than a million times the scene's size away");
    }
  }
  const Vec3d forward = vec::unit(view);
  const Vec3d right = vec::unit(across);
  const double pixel_edge = 2 * std::tan(camera.field_of_view_degrees * std::numbers::pi / 360) / height;
  view_.forward = to_float(forward);
  view_.right = to_float(vec::scale(right, pixel_edge));
  view_.down = to_float(vec::scale(vec::cross(forward, right), pixel_edge));
  if (camera.aperture > 0) {
    const double radius = 0.5 * camera.aperture * space.scale;
    view_.lens_right = to_float(vec::scale(right, radius));
    view_.lens_down = to_float(vec::scale(vec::cross(forward, right), radius));
    view_.inverse_focus = static_cast<float>(1 / (focus_distance(camera) * space.scale));
  }
  view_.width = width;
  view_.height = height;
  view_.samples = samples_.count();
  view_.seed = seed;
  view_.filter_bits = samples_.filter_bits();
}

CameraRay CameraRays::ray(std::uint32_t pixel, std::uint32_t sample) const {
  const protocol::CameraPixel from = protocol::camera_pixel(view_, pixel % view_.width, pixel / view_.width);
  const protocol::SamplePlace& place = samples_.places()[sample];
  const std::uint32_t key = protocol::camera_key(from, sample);
  if (!protocol::has_lens(view_))
    return {view_.eye, protocol::camera_direction(view_, from, place, samples_.distances()), key};
  const protocol::LensRay ray = protocol::lens_ray(view_, from, sample, place, samples_.distances());
  return {ray.origin, ray.direction, key};
}

std::optional<FirstSubspace> first_subspace(const Grid& grid, const protocol::Vec3f& origin,
                                            const protocol::Vec3f& direction, const std::vector<bool>* filled,
                                            std::uint64_t* entered) {
  const protocol::GridShape shape = grid.shape();
  std::optional<protocol::FirstCell> start = protocol::first_cell(shape, origin, direction);
  if (!start) return std::nullopt;
  const protocol::RayPlanes planes(shape, origin, direction);
  std::uint64_t cells = 1;
  while (filled != nullptr && !(*filled)[grid.index(start->cell)]) {
    std::size_t axis = 0;
    for (std::size_t other = 1; other < 3; ++other) {
      if (planes.exit(other, start->cell[other]) < planes.exit(axis, start->cell[axis])) axis = other;
    }
    std::uint32_t& cell = start->cell[axis];
    if (cell == (planes.upward(axis) ? grid.cells[axis] - 1 : 0)) {
      start.reset();
      break;
    }
    cell += planes.upward(axis) ? 1U : ~0U;
    start->flags = static_cast<std::uint8_t>(axis << protocol::kEntryAxisShift);
    ++cells;
  }
  if (entered != nullptr) *entered += cells;
  if (!start) return std::nullopt;
  return FirstSubspace{grid.index(start->cell), start->flags};
}

}  // namespace torolux
