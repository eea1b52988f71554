// SPDX-License-Identifier: MIT
// Compares the emitters' widths with the object space, in which PEs reckon in single precision.
#include "host_tools/scene/small_emitters.hpp"

#include <cmath>
#include <cstddef>
#include <map>
#include <sstream>

#include "host_tools/scene/components.hpp"
#include "host_tools/scene/sky.hpp"
#include "host_tools/scene/vec.hpp"

namespace torolux {
namespace {

/// Of the scene's longest edge, up to which a tenth of the light is lost or more. Of flat ones rays pass by the edges
/// of thin triangles. Of bodies, what leaves one face begins within the rounding of another one, which then takes it
/// (firmware/pe/traverse.cpp).
constexpr double kLeastFlat = 1.0 / 200'000;
constexpr double kLeastBody = 1.0 / 100'000;
constexpr std::size_t kMostTold = 8;

double area_of(const Scene& scene, const Component& component) {
  double area = 0;
  for (const std::uint32_t t : component.triangles) {
    const auto& [a, b, c] = scene.triangles[t].position;
    const Vec3d& from = scene.positions[a];
    area +=
        0.5 * vec::length(vec::cross(vec::subtract(scene.positions[b], from), vec::subtract(scene.positions[c], from)));
  }
  return area;
}

/// The edge of a cube, the diameter of a sphere, the width of a strip.
double width_of(const Scene& scene, const Component& component) {
  const double area = area_of(scene, component);
  if (component.closed) return 6 * std::abs(component.volume) / area;
  return area / vec::largest(component.box.extent());
}

struct Smallest {
  const Component* component = nullptr;
  double width = 0;  ///< of it
  double least = 0;  ///< allowed
  std::size_t count = 0;
};

std::string sentence(const Scene& scene, std::uint32_t material, const Smallest& of) {
  std::ostringstream text;
  const Vec3d at = of.component->box.centre();
  text << "emitter '" << scene.materials[material].name << "' around " << at[0] << "," << at[1] << "," << at[2]
       << " is " << of.width << " across";
  if (of.count > 1) text << " (and " << of.count - 1 << " more)";
  text << ", too small for its scene: of less than " << of.least << ", "
       << (of.component->closed ? "1/100,000" : "1/200,000")
       << " of it, light is lost, for rays in single precision pass by; make it larger and its emission less, or the "
          "scene smaller";
  return text.str();
}

/// What emits, and nothing else: surfaces that hang together in it are emitters, though a lamp be part of a wall.
Scene without_the_dark(const Scene& scene) {
  Scene shining;
  shining.positions = scene.positions;
  shining.materials = scene.materials;
  for (const SceneTriangle& triangle : scene.triangles)
    if (emits(scene.materials[triangle.material])) shining.triangles.push_back(triangle);
  return shining;
}

/// By material.
std::map<std::uint32_t, Smallest> too_small(const Scene& shining, const std::vector<Component>& all, double size) {
  std::map<std::uint32_t, Smallest> found;
  for (const Component& component : all) {
    const double least = size * (component.closed ? kLeastBody : kLeastFlat);
    const double width = width_of(shining, component);
    if (!(width < least)) continue;
    Smallest& smallest = found[shining.triangles[component.triangles[0]].material];
    if (smallest.count++ == 0 || width < smallest.width) {
      smallest.component = &component;
      smallest.width = width;
      smallest.least = least;
    }
  }
  return found;
}

}  // namespace

std::vector<std::string> small_emitters(const Scene& scene) {
  vec::Box box;
  for (const Vec3d& p : scene.positions) box.include(p);
  include_openings(scene, box);
  const Scene shining = without_the_dark(scene);
  const std::vector<Component> all = components(shining);
  std::vector<std::string> found;
  std::size_t left_out = 0;
  for (const auto& [material, smallest] : too_small(shining, all, vec::largest(box.extent()))) {
    if (found.size() < kMostTold)
      found.push_back(sentence(scene, material, smallest));
    else
      ++left_out;
  }
  if (left_out > 0) found.push_back(std::to_string(left_out) + " more materials emit from too small surfaces");
  return found;
}

}  // namespace torolux
