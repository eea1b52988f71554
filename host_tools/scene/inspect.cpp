// SPDX-License-Identifier: MIT
// Looks for what is probably wound or placed wrongly, and words it.
#include "host_tools/scene/inspect.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <sstream>

#include "host_tools/scene/components.hpp"
#include "host_tools/scene/coplanar.hpp"
#include "host_tools/scene/ray_cast.hpp"
#include "host_tools/scene/sky.hpp"
#include "host_tools/scene/small_emitters.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

std::string around(const vec::Box& box) {
  std::ostringstream text;
  const Vec3d c = box.centre();
  text << " around " << c[0] << "," << c[1] << "," << c[2];
  return text.str();
}

bool holds(const vec::Box& outer, const vec::Box& inner) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!(outer.low[axis] <= inner.low[axis] && inner.high[axis] <= outer.high[axis])) return false;
  return true;
}

/// Distance to the nearest triangle but one, or HUGE_VAL.
double nearest_hit(const Scene& scene, const Vec3d& origin, const Vec3d& direction, std::uint32_t without) {
  const auto hit = cast_ray(scene, origin, direction, without);
  return hit ? hit->distance : HUGE_VAL;
}

/// A lamp that faces a wall nearer than this, of the scene, and has so many times more way behind it, lights the wall
/// alone.
constexpr double kClose = 0.05;
constexpr double kOpen = 10;

struct Emitter {
  std::uint32_t triangle;
  Vec3d centre, normal;
};

std::vector<Emitter> emitters(const Scene& scene, std::size_t most) {
  std::vector<Emitter> found;
  for (std::uint32_t t = 0; t < scene.triangles.size() && found.size() < most; ++t) {
    const SceneTriangle& triangle = scene.triangles[t];
    if (!emits(scene.materials[triangle.material])) continue;
    const Vec3d& a = scene.positions[triangle.position[0]];
    const Vec3d& b = scene.positions[triangle.position[1]];
    const Vec3d& c = scene.positions[triangle.position[2]];
    found.push_back({t, vec::scale(vec::add(vec::add(a, b), c), 1.0 / 3), front_normal(scene, t)});
  }
  return found;
}

void inspect_emitters(const Scene& scene, double size, std::vector<std::string>& found) {
  // Rays cost a pass over the scene each.
  const std::size_t most = std::clamp<std::size_t>(20'000'000 / (scene.triangles.size() + 1), 4, 64);
  struct Count {
    std::size_t against = 0, away = 0, close = 0, of = 0;
  };
  std::map<std::uint32_t, Count> by_material;
  for (const Emitter& emitter : emitters(scene, most)) {
    Count& count = by_material[scene.triangles[emitter.triangle].material];
    ++count.of;
    // A coincident surface lies at distance 0: the ray begins a little behind the emitter.
    const double behind = 1e-7 * size;
    const Vec3d origin = vec::subtract(emitter.centre, vec::scale(emitter.normal, behind));
    const double ahead = nearest_hit(scene, origin, emitter.normal, emitter.triangle);
    if (ahead < behind + 1e-5 * size) {
      ++count.against;
      continue;
    }
    const Vec3d back = vec::scale(emitter.normal, -1);
    const auto behind_it = cast_ray(scene, emitter.centre, back, emitter.triangle);
    const double way_back = behind_it ? behind_it->distance : HUGE_VAL;
    if (ahead < kClose * size && way_back > kOpen * ahead) ++count.close;
    // A bulb has its own other side behind each of its fronts.
    const auto material_of = [&scene](std::uint32_t t) { return scene.triangles[t].material; };
    if (ahead == HUGE_VAL && behind_it && way_back > 1e-5 * size &&
        material_of(behind_it->triangle) != material_of(emitter.triangle))
      ++count.away;
  }
  for (const auto& [material, count] : by_material) {
    const std::string which =
        "emitter '" + scene.materials[material].name + "' (" + std::to_string(count.of) + " triangles looked at): ";
    if (count.against > 0)
      found.push_back(which + std::to_string(count.against) +
                      " have their front against another surface, so that no light leaves them; wind them the other "
                      "way round, or use --two-sided-lights");
    if (count.away > 0)
      found.push_back(which + std::to_string(count.away) +
                      " have nothing before their front but something behind; they look inverted "
                      "(--two-sided-lights makes both sides shine)");
    if (count.close == count.of)
      found.push_back(which +
                      "all face a surface close before them, with open space behind; they look inverted "
                      "(--two-sided-lights makes both sides shine)");
  }
}

/// Rays from an opening's middle to this side of it that meet a surface, of five.
std::size_t met_before(const Scene& scene, const SkyQuad& opening, const Vec3d& facing, double size) {
  const Vec3d middle = vec::add(opening.corner, vec::scale(vec::add(opening.along, opening.across), 0.5));
  const Vec3d origin = vec::add(middle, vec::scale(facing, 1e-4 * size));
  const Vec3d u = vec::unit(opening.along);
  const Vec3d v = vec::cross(facing, u);
  std::size_t met = 0;
  for (const Vec3d& aside : {Vec3d{0, 0, 0}, u, vec::scale(u, -1), v, vec::scale(v, -1)}) {
    const auto hit = cast_ray(scene, origin, vec::add(facing, aside));
    if (hit && scene.materials[scene.triangles[hit->triangle].material].kind != SurfaceKind::glass) ++met;
  }
  return met;
}

/// Light comes in along an opening's front: nothing before it and the scene behind it is the wrong way round.
void inspect_openings(const Scene& scene, double size, std::vector<std::string>& found) {
  if (!scene.sky) return;
  std::size_t number = 0;
  for (const SkyQuad& opening : scene.sky->openings) {
    ++number;
    const Vec3d facing = vec::unit(vec::cross(opening.along, opening.across));
    if (met_before(scene, opening, facing, size) > 0) continue;
    if (met_before(scene, opening, vec::scale(facing, -1), size) < 3) continue;
    vec::Box box;
    include_opening(opening, box);
    found.push_back("[[sky.opening]] " + std::to_string(number) + around(box) +
                    " faces outwards, so that its light goes away from the scene; swap its 'edges', or turn 'facing'");
  }
}

std::string name_of(const Scene& scene, const Component& component) {
  return "'" + scene.materials[scene.triangles[component.triangles[0]].material].name + "'" + around(component.box);
}

/// Does any other component with triangles lie inside its box? Only the larger of two can hold the other.
bool is_room(const std::vector<Component>& all, const Component& room, double scene_size) {
  const double size = vec::largest(room.box.extent());
  if (size < 0.25 * scene_size) return false;
  return std::any_of(all.begin(), all.end(), [&](const Component& other) {
    return &other != &room && vec::largest(other.box.extent()) < size && holds(room.box, other.box);
  });
}

bool inside_other_glass(const Scene& scene, const std::vector<Component>& all, const Component& inner) {
  return std::any_of(all.begin(), all.end(), [&](const Component& outer) {
    return &outer != &inner && outer.closed && outer.volume > -inner.volume && holds(outer.box, inner.box) &&
           scene.materials[scene.triangles[outer.triangles[0]].material].kind == SurfaceKind::glass;
  });
}

void inspect_winding(const Scene& scene, double size, std::vector<std::string>& found) {
  constexpr std::size_t most_told = 8;
  const std::vector<Component> all = components(scene);
  std::size_t told = 0;
  std::size_t left_out = 0;
  const auto tell = [&](const std::string& text) {
    if (told++ < most_told)
      found.push_back(text);
    else
      ++left_out;
  };
  // Many components: asking each for what it holds would take the square of their number.
  const bool look_for_rooms = all.size() < 20000;
  for (const Component& component : all) {
    const SceneMaterial& material = scene.materials[scene.triangles[component.triangles[0]].material];
    if (material.thin) continue;
    if (material.kind == SurfaceKind::glass) {
      if (!component.closed)
        tell("glass " + name_of(scene, component) +
             (component.one_way ? " is open: light that enters it may never be seen to leave"
                                : " is not wound one way round: light cannot tell inside from outside"));
      else if (component.volume < 0 && !(look_for_rooms && inside_other_glass(scene, all, component)))
        tell("glass " + name_of(scene, component) + " is inside out: its fronts face inwards");
      continue;
    }
    if (!component.closed) {
      if (!component.one_way) tell("surface " + name_of(scene, component) + " is not wound one way round");
      continue;
    }
    const bool room = look_for_rooms && is_room(all, component, size);
    if (room && component.volume > 0 && material.kind == SurfaceKind::diffuse)
      tell("closed room " + name_of(scene, component) + " has its fronts outwards; they are expected inwards");
    const bool whole = vec::largest(component.box.extent()) >= size;
    if (!room && !whole && component.volume < 0)
      tell("closed solid " + name_of(scene, component) + " has its fronts inwards; they are expected outwards");
  }
  if (left_out > 0) found.push_back(std::to_string(left_out) + " more surfaces look inverted or open");
}

}  // namespace

std::vector<std::string> inspect(const Scene& scene) {
  std::vector<std::string> found;
  if (scene.triangles.empty()) return found;
  vec::Box box;
  for (const Vec3d& p : scene.positions) box.include(p);
  const double size = vec::largest(box.extent());
  inspect_winding(scene, size, found);
  inspect_emitters(scene, size, found);
  std::ranges::move(small_emitters(scene), std::back_inserter(found));
  inspect_openings(scene, size, found);
  inspect_coplanar(scene, found);
  return found;
}

}  // namespace torolux
