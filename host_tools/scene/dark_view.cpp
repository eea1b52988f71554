// SPDX-License-Identifier: MIT
// Looks for light along paths from the camera, and words what was in its way where there is none.
#include "host_tools/scene/dark_view.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "firmware/protocol/random.hpp"
#include "host_tools/scene/ray_cast.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

constexpr std::uint32_t kMostPaths = 256;
/// With fewer nothing is said: light that comes through a door is easily missed.
constexpr std::uint32_t kLeastPaths = 24;
constexpr std::uint32_t kMostBounces = 8;
constexpr double kLeastCosine = 1e-6;

using Names = std::map<std::string, std::uint32_t>;

/// The name that was counted most often; "" where none was.
std::string most_frequent(const Names& names) {
  const auto most = std::ranges::max_element(names, {}, [](const auto& entry) { return entry.second; });
  return most == names.end() ? "" : most->first;
}

class LightSearch {
 public:
  LightSearch(const Scene& scene, const Camera& camera, double aspect, bool two_sided_lights)
      : scene_(scene), camera_(camera), aspect_(aspect), two_sided_lights_(two_sided_lights) {
    for (std::uint32_t t = 0; t < scene.triangles.size(); ++t)
      if (emits(material_of(t))) emitters_.push_back(t);
    // Rays cost a pass over the scene each.
    rays_left_ = std::clamp<std::size_t>(30'000'000 / (scene.triangles.size() + 1), 64, 8000);
  }

  std::vector<std::string> run() {
    if (emitters_.empty() || scene_.sky) return {};
    for (; paths_ < kMostPaths && rays_left_ > 0; ++paths_)
      if (finds_light()) return {};
    if (paths_ < kLeastPaths) return {};
    if (seen_.empty()) return {"the camera sees nothing of the scene: it looks past it or away from it"};
    return {"no light reaches what the camera sees, and the picture will be black" + reasons()};
  }

 private:
  const SceneMaterial& material_of(std::uint32_t triangle) const {
    return scene_.materials[scene_.triangles[triangle].material];
  }

  double random() { return static_cast<double>(protocol::uniform_float(protocol::hash_combine(1, next_random_++))); }

  std::optional<SceneHit> cast(const Vec3d& origin, const Vec3d& direction, std::uint32_t without) {
    rays_left_ -= std::min<std::size_t>(rays_left_, 1);
    return cast_ray(scene_, origin, direction, without);
  }

  Vec3d camera_direction() {
    const Vec3d forward = vec::unit(vec::subtract(camera_.look_at, camera_.eye));
    const Vec3d right = vec::unit(vec::cross(forward, camera_.up));
    const Vec3d up = vec::cross(right, forward);
    const double half = std::tan(camera_.field_of_view_degrees * std::numbers::pi / 360);
    const double x = (2 * random() - 1) * half * aspect_;
    const double y = (2 * random() - 1) * half;
    return vec::unit(vec::add(forward, vec::add(vec::scale(right, x), vec::scale(up, y))));
  }

  /// By the cosine to `normal`.
  Vec3d diffuse_direction(const Vec3d& normal) {
    const double radius = std::sqrt(random());
    const double angle = 2 * std::numbers::pi * random();
    const Vec3d aside = std::abs(normal[0]) > 0.5 ? Vec3d{0, 1, 0} : Vec3d{1, 0, 0};
    const Vec3d u = vec::unit(vec::cross(aside, normal));
    const Vec3d v = vec::cross(normal, u);
    return vec::unit(
        vec::add(vec::add(vec::scale(u, radius * std::cos(angle)), vec::scale(v, radius * std::sin(angle))),
                 vec::scale(normal, std::sqrt(std::max(0.0, 1 - radius * radius)))));
  }

  /// One path. Glass lets straight through, which is near enough here.
  bool finds_light() {
    Vec3d origin = camera_.eye;
    Vec3d direction = camera_direction();
    std::uint32_t without = kNoTriangle;
    for (std::uint32_t bounce = 0; bounce < kMostBounces; ++bounce) {
      const auto hit = cast(origin, direction, without);
      if (!hit) return false;
      const SceneMaterial& material = material_of(hit->triangle);
      if (emits_from(scene_, material, hit->front ? 0 : 1, two_sided_lights_)) return true;
      if (bounce == 0) {
        ++seen_[material.name];
        if (hit->front) sees_fronts_ = true;
      }
      Vec3d normal = front_normal(scene_, hit->triangle);
      if (!hit->front) normal = vec::scale(normal, -1);
      origin = vec::add(origin, vec::scale(direction, hit->distance));
      without = hit->triangle;
      if (material.kind == SurfaceKind::mirror) {
        direction = vec::subtract(direction, vec::scale(normal, 2 * vec::dot(direction, normal)));
      } else if (material.kind == SurfaceKind::diffuse) {
        if (material.diffuse == Vec3d{0, 0, 0} && material.specular == Vec3d{0, 0, 0}) return false;
        reflects_ = true;
        if (sees_emitter(origin, normal, without)) return true;
        direction = diffuse_direction(normal);
      }
    }
    return false;
  }

  /// Does light come straight from a point of an emitter chosen by chance?
  bool sees_emitter(const Vec3d& from, const Vec3d& normal, std::uint32_t without) {
    const auto pick = static_cast<std::size_t>(random() * static_cast<double>(emitters_.size()));
    const std::uint32_t emitter = emitters_[std::min(pick, emitters_.size() - 1)];
    const auto& [a, b, c] = scene_.triangles[emitter].position;
    double u = random();
    double v = random();
    if (u + v > 1) {
      u = 1 - u;
      v = 1 - v;
    }
    const Vec3d point = vec::add(vec::scale(scene_.positions[a], 1 - u - v),
                                 vec::add(vec::scale(scene_.positions[b], u), vec::scale(scene_.positions[c], v)));
    const Vec3d way = vec::subtract(point, from);
    // What lies in the plane of a lamp sees nothing of it: there the sign is rounding.
    const double least = kLeastCosine * vec::length(way);
    if (!(vec::dot(way, normal) > least) || std::abs(vec::dot(way, front_normal(scene_, emitter))) < least)
      return false;
    const auto hit = cast(from, way, without);
    if (hit && hit->triangle != emitter && hit->distance < 1 - 1e-6) {
      ++between_[material_of(hit->triangle).name];
      return false;
    }
    const std::size_t side = vec::dot(way, front_normal(scene_, emitter)) < 0 ? 0 : 1;
    if (emits_from(scene_, material_of(emitter), side, two_sided_lights_)) return true;
    ++away_[material_of(emitter).name];
    return false;
  }

  std::string reasons() const {
    std::string text;
    if (!reflects_) return ": it reflects nothing ('" + most_frequent(seen_) + "' most)";
    if (!sees_fronts_)
      text += "; the camera sees back sides only ('" + most_frequent(seen_) +
              "' most): it stands behind a wall or inside a solid";
    if (const std::string name = most_frequent(away_); !name.empty())
      text += "; '" + name + "' turns its back on it (--two-sided-lights makes both sides shine)";
    if (const std::string name = most_frequent(between_); !name.empty())
      text += "; '" + name + "' stands between it and the light";
    return text;
  }

  const Scene& scene_;
  const Camera& camera_;
  double aspect_;
  bool two_sided_lights_;
  std::vector<std::uint32_t> emitters_;
  std::size_t rays_left_ = 0;
  std::uint32_t paths_ = 0, next_random_ = 0;
  bool sees_fronts_ = false, reflects_ = false;
  Names seen_, between_, away_;  // by material
};

}  // namespace

std::vector<std::string> inspect_view(const Scene& scene, const Camera& camera, double aspect, bool two_sided_lights) {
  return LightSearch(scene, camera, aspect, two_sided_lights).run();
}

}  // namespace torolux
