// SPDX-License-Identifier: MIT
// See camera_rays.hpp.
#include "host_tools/stages/camera_rays.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "emulator/errors.hpp"
#include "firmware/protocol/random.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {

CameraRays::CameraRays(const Camera& camera, const SceneSpace& space, std::uint32_t width, std::uint32_t height,
                       PixelSamples samples, std::uint32_t seed)
    : width_(width),
      height_(height),
      seed_(seed),
      samples_(std::move(samples)),
      eye_(to_float(space.to_normalised(camera.eye))) {
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
  for (const float coordinate : eye_) {
    if (!(std::abs(coordinate) < 1e6F)) {
      throw InputError("the camera's eye is more than a million times the scene's size away");
    }
  }
  forward_ = vec::unit(view);
  const Vec3d right = vec::unit(across);
  const double half_height = std::tan(camera.field_of_view_degrees * std::numbers::pi / 360);
  down_ = vec::scale(vec::cross(forward_, right), half_height);
  right_ = vec::scale(right, half_height * width / height);
}

CameraRay CameraRays::ray(std::uint32_t pixel, std::uint32_t sample) const {
  CameraRay ray{};
  ray.origin = eye_;
  ray.key = protocol::hash_combine(protocol::hash_combine(seed_, pixel), sample);
  const std::uint32_t column = pixel % width_;
  const std::uint32_t row = pixel / width_;
  const PixelPlace place = samples_.place(column, row, sample);
  const double x = 2 * (column + place.x) / width_ - 1;
  const double y = 2 * (row + place.y) / height_ - 1;
  ray.direction = to_float(vec::unit(vec::add(forward_, vec::add(vec::scale(right_, x), vec::scale(down_, y)))));
  return ray;
}

namespace {

/// Distances to planes as firmware/pe/walk.hpp has them.
class Planes {
 public:
  Planes(const Grid& grid, const protocol::Vec3f& origin, const protocol::Vec3f& direction)
      : grid_(grid), origin_(origin) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      inverse_[axis] = std::abs(direction[axis]) >= 0x1p-64F ? 1.0F / direction[axis] : 0.0F;
      upward_[axis] = !std::signbit(direction[axis]);
    }
  }
  bool meets(std::size_t axis) const { return inverse_[axis] != 0; }
  bool upward(std::size_t axis) const { return upward_[axis]; }
  float distance(std::size_t axis, std::uint32_t plane) const {
    return meets(axis) ? (grid_.plane(axis, plane) - origin_[axis]) * inverse_[axis] : HUGE_VALF;
  }
  float exit(std::size_t axis, std::uint32_t cell) const { return distance(axis, cell + (upward_[axis] ? 1U : 0U)); }

 private:
  const Grid& grid_;
  protocol::Vec3f origin_;
  protocol::Vec3f inverse_{};
  std::array<bool, 3> upward_{};
};

std::uint8_t entry_flags(std::size_t axis) {
  return static_cast<std::uint8_t>(axis << protocol::kEntryAxisShift);
}

struct Start {
  std::array<std::uint32_t, 3> cell;
  std::uint8_t flags;
};

/// From outside: the cell behind the last of the three planes through which the ray enters.
std::optional<Start> enter(const Grid& grid, const Planes& planes, const protocol::Vec3f& origin) {
  float entry = -HUGE_VALF;
  float exit = HUGE_VALF;
  std::size_t entry_axis = 3;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::uint32_t last = grid.cells[axis];
    if (!planes.meets(axis)) {
      if (origin[axis] < 0 || origin[axis] > grid.plane(axis, last)) return std::nullopt;
      continue;
    }
    const float in = planes.distance(axis, planes.upward(axis) ? 0 : last);
    if (in >= entry) {
      entry = in;
      entry_axis = axis;
    }
    exit = std::min(exit, planes.distance(axis, planes.upward(axis) ? last : 0));
  }
  if (entry_axis == 3 || entry > exit || exit < 0) return std::nullopt;
  Start start{grid.cell_of(origin), entry_flags(entry_axis)};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (!planes.meets(axis)) continue;
    const std::uint32_t last = grid.cells[axis] - 1;
    std::uint32_t& cell = start.cell[axis];
    cell = planes.upward(axis) ? 0 : last;
    if (axis == entry_axis) continue;
    while (planes.exit(axis, cell) < entry && cell != (planes.upward(axis) ? last : 0)) {
      cell += planes.upward(axis) ? 1U : ~0U;
    }
  }
  return start;
}

}  // namespace

std::optional<FirstSubspace> first_subspace(const Grid& grid, const protocol::Vec3f& origin,
                                            const protocol::Vec3f& direction, const std::vector<bool>* filled,
                                            std::uint64_t* entered) {
  const Planes planes(grid, origin, direction);
  bool inside = true;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    inside = inside && origin[axis] >= 0 && origin[axis] < grid.plane(axis, grid.cells[axis]);
  }
  std::optional<Start> start = inside ? Start{grid.cell_of(origin), protocol::kFirst} : enter(grid, planes, origin);
  if (!start) return std::nullopt;
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
    start->flags = entry_flags(axis);
    ++cells;
  }
  if (entered != nullptr) *entered += cells;
  if (!start) return std::nullopt;
  return FirstSubspace{grid.index(start->cell), start->flags};
}

}  // namespace torolux
