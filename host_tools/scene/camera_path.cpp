// SPDX-License-Identifier: MIT
// Reads the [[camera]] tables, and puts pictures between them.
#include "host_tools/scene/camera_path.hpp"

#include <algorithm>

#include "host_tools/scene/camera.hpp"
#include "host_tools/scene/camera_entry.hpp"

namespace torolux {
namespace {

struct Key {
  Camera camera;
  std::uint64_t frames;  ///< from here up to the next one, which is not counted
  Place place;
};

std::vector<Key> read_keys(TomlTable& table, const toml::table& top, const std::string& file, const Camera& like) {
  std::vector<Key> keys;
  std::uint64_t all = 0;
  for (const toml::table* entry : table.tables("camera")) {
    TomlTable camera(*entry, file, "[[camera]]");
    Key key{read_camera(camera, "[[camera]]", keys.empty() ? like : keys.back().camera),
            camera.integer("frames", 1, kMostPathFrames).value_or(1), camera.place()};
    camera.finish();
    all += key.frames;
    if (all > kMostPathFrames) {
      refuse(key.place, "[[camera]] up to here are " + std::to_string(all) + " pictures; the most is " +
                            std::to_string(kMostPathFrames));
    }
    keys.push_back(std::move(key));
  }
  if (keys.empty()) refuse(place_of(top, file), "there is no [[camera]]; a path has at least one");
  return keys;
}

/// Uniform Catmull-Rom: at t = 0 the second value, at 1 the third.
double spline(const std::array<double, 4>& at, double t) {
  return at[1] + 0.5 * t *
                     (at[2] - at[0] +
                      t * (2 * at[0] - 5 * at[1] + 4 * at[2] - at[3] + t * (3 * (at[1] - at[2]) + at[3] - at[0])));
}

Vec3d spline(const std::array<const Vec3d*, 4>& at, double t) {
  Vec3d value{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    value[axis] = spline({(*at[0])[axis], (*at[1])[axis], (*at[2])[axis], (*at[3])[axis]}, t);
  }
  return value;
}

Camera between(const std::array<const Camera*, 4>& at, double t) {
  const auto of = [&](Vec3d Camera::*part) {
    return spline({&(at[0]->*part), &(at[1]->*part), &(at[2]->*part), &(at[3]->*part)}, t);
  };
  Camera camera;
  camera.eye = of(&Camera::eye);
  camera.look_at = of(&Camera::look_at);
  camera.up = of(&Camera::up);
  const auto angle = [&](std::size_t i) { return at[i]->field_of_view_degrees; };
  camera.field_of_view_degrees = std::clamp(spline({angle(0), angle(1), angle(2), angle(3)}, t), 0.01, 179.0);
  const auto aperture = [&](std::size_t i) { return at[i]->aperture; };
  camera.aperture = std::max(spline({aperture(0), aperture(1), aperture(2), aperture(3)}, t), 0.0);
  const auto focus = [&](std::size_t i) { return focus_distance(*at[i]); };
  const bool same = std::ranges::all_of(at, [&](const Camera* one) { return one->focus == at[0]->focus; });
  if (same)
    camera.focus = at[0]->focus;
  else
    camera.focus = spline({focus(0), focus(1), focus(2), focus(3)}, t);
  return camera;
}

}  // namespace

std::vector<Camera> read_camera_path(std::string_view text, const std::string& file, const Camera& like) {
  const toml::table top = parse_toml(text, file);
  TomlTable table(top, file, "the file");
  const bool closed = table.flag("closed").value_or(false);
  const std::vector<Key> keys = read_keys(table, top, file, like);
  table.finish();
  const std::size_t count = keys.size();
  if (!closed && keys.back().frames != 1) {
    refuse(keys.back().place,
           "[[camera]] is the last one, and nothing comes after it: leave out its 'frames', or say "
           "closed = true at the top of the file for a path that goes back to the first");
  }
  const auto key = [&](std::size_t i, std::size_t on) {  // one before the first: on = 0
    if (closed) return &keys[(i + count + on - 1) % count].camera;
    return &keys[std::min(count, std::max<std::size_t>(1, i + on)) - 1].camera;
  };
  std::vector<Camera> cameras;
  for (std::size_t i = 0; i < count; ++i) {
    for (std::uint64_t frame = 0; frame < keys[i].frames; ++frame) {
      const double t = static_cast<double>(frame) / static_cast<double>(keys[i].frames);
      cameras.push_back(frame == 0 ? keys[i].camera : between({key(i, 0), key(i, 1), key(i, 2), key(i, 3)}, t));
      if (const auto wrong = camera_fault(cameras.back())) {
        refuse(keys[i].place, "[[camera]] the camera of picture " + std::to_string(frame) + " after it " + *wrong);
      }
    }
  }
  return cameras;
}

}  // namespace torolux
