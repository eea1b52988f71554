// SPDX-License-Identifier: MIT
// Makes an icosahedron of a point light, an octagon of a spot, and notes a sun.
#include "host_tools/scene/gltf_lights.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/scene/statements.hpp"

namespace torolux {
namespace {

struct Body {
  std::vector<Vec3d> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;

  double area() const {
    double sum = 0;
    for (const auto& t : triangles)
      sum += 0.5 * vec::length(vec::cross(vec::subtract(positions[t[1]], positions[t[0]]),
                                          vec::subtract(positions[t[2]], positions[t[0]])));
    return sum;
  }
};

Body icosahedron(const Vec3d& centre, double radius) {
  constexpr double g = std::numbers::phi;
  constexpr std::array<Vec3d, 12> corners{Vec3d{-1, g, 0}, Vec3d{1, g, 0}, Vec3d{-1, -g, 0}, Vec3d{1, -g, 0},
                                          Vec3d{0, -1, g}, Vec3d{0, 1, g}, Vec3d{0, -1, -g}, Vec3d{0, 1, -g},
                                          Vec3d{g, 0, -1}, Vec3d{g, 0, 1}, Vec3d{-g, 0, -1}, Vec3d{-g, 0, 1}};
  Body body;
  for (const Vec3d& corner : corners) body.positions.push_back(vec::add(centre, vec::scale(vec::unit(corner), radius)));
  body.triangles = {{0, 11, 5},  {0, 5, 1},  {0, 1, 7},  {0, 7, 10}, {0, 10, 11}, {1, 5, 9}, {5, 11, 4},
                    {11, 10, 2}, {10, 7, 6}, {7, 1, 8},  {3, 9, 4},  {3, 4, 2},   {3, 2, 6}, {3, 6, 8},
                    {3, 8, 9},   {4, 9, 5},  {2, 4, 11}, {6, 2, 10}, {8, 6, 7},   {9, 8, 1}};
  return body;
}

/// Faces along `axis`.
Body octagon(const Vec3d& centre, const Vec3d& axis, double radius) {
  const Vec3d aside = std::abs(axis[0]) < 0.9 ? Vec3d{1, 0, 0} : Vec3d{0, 1, 0};
  const Vec3d u = vec::unit(vec::cross(aside, axis));
  const Vec3d v = vec::cross(axis, u);
  Body body;
  for (std::uint32_t i = 0; i < 8; ++i) {
    const double angle = std::numbers::pi / 4 * i;
    body.positions.push_back(
        vec::add(centre, vec::add(vec::scale(u, radius * std::cos(angle)), vec::scale(v, radius * std::sin(angle)))));
    if (i >= 2) body.triangles.push_back({0, i - 1, i});
  }
  return body;
}

void add_body(const Body& body, const std::string& name, const Vec3d& emission, const Place& place,
              ImportedMesh& mesh) {
  SceneMaterial material;
  material.name = name;
  material.emission = emission;
  const auto first = static_cast<std::uint32_t>(mesh.positions.size());
  const auto part = static_cast<std::uint32_t>(mesh.parts.size());
  const auto number = static_cast<std::uint32_t>(mesh.materials.size());
  mesh.materials.push_back({material, true, place});
  mesh.parts.push_back(place.file);
  mesh.positions.insert(mesh.positions.end(), body.positions.begin(), body.positions.end());
  for (const auto& t : body.triangles)
    mesh.triangles.push_back(
        {{first + t[0], first + t[1], first + t[2]}, {kNoNormal, kNoNormal, kNoNormal}, number, part});
}

/// What shines at one place, one way.
struct Lamp {
  std::string name;
  Place place;
  Vec3d centre;
  std::optional<Vec3d> axis;  ///< of a spot; unit
  Vec3d power;                ///< [W/sr]
  double size;                ///< half the body's width
};

/// A fraction of a light's size: nearer ones are at one place.
constexpr double kOnePlace = 1e-3;

bool at_one_place(const Lamp& a, const Lamp& b) {
  return vec::length(vec::subtract(a.centre, b.centre)) <= kOnePlace * a.size;
}

bool shine_alike(const Lamp& a, const Lamp& b) {
  constexpr double same_axis = 0.999999;
  return at_one_place(a, b) && a.axis.has_value() == b.axis.has_value() &&
         (!a.axis || vec::dot(*a.axis, *b.axis) > same_axis);
}

/// Absent: it does not shine, or is a sun, which is in `mesh` then.
std::optional<Lamp> lamp_of(const GltfObject& object, const GltfLight& light, double size, GltfUnits units,
                            ImportedMesh& mesh, Notices& notices) {
  const Place place = object.place();
  const std::string type = object.text("type").value_or("");
  const double intensity = object.number("intensity", 0, kMostCoordinate).value_or(1) * radiance_per_luminance(units);
  // [W/sr]; of a sun [W/m^2]
  const Vec3d power = vec::scale(object.colour("color").value_or(Vec3d{1, 1, 1}), intensity);
  const std::string name = object.text("name").value_or("light " + std::to_string(light.number));
  if (object.has("range")) notices.note("the range of a light is not used: light goes on for ever", place);
  if (type != "point" && type != "spot" && type != "directional")
    refuse(place, "'type' is " + in_quotes(type) + "; expected point, spot or directional");
  if (!(vec::largest(power) > 0)) return std::nullopt;
  const Vec3d backwards = light.place.axes[2];
  if (type != "point" && !(vec::length(backwards) > 0)) refuse(place, "its node's scale is zero: it shines nowhere");
  if (type == "directional") {
    mesh.suns.push_back({backwards, power, place});
    return std::nullopt;
  }
  Lamp lamp{name, place, light.place.origin, std::nullopt, power, size};
  if (type == "spot") {
    notices.note(
        "a spot is a disc that has its intensity on the axis and falls off as the cosine: its cone is not rendered",
        place);
    lamp.axis = vec::scale(vec::unit(backwards), -1);
  }
  return lamp;
}

/// Pairs of lights are looked at, of not more than these.
constexpr std::size_t kMostPaired = 2000;

/// Bodies that reach into each other would take each other's light.
void keep_apart(std::vector<Lamp>& lamps) {
  if (lamps.size() > kMostPaired) return;
  for (Lamp& lamp : lamps) {
    for (const Lamp& other : lamps) {
      const double distance = vec::length(vec::subtract(lamp.centre, other.centre));
      if (&lamp != &other && !at_one_place(lamp, other)) lamp.size = std::min(lamp.size, 0.49 * distance);
    }
  }
  // A spot stands before what shines another way at its place.
  std::vector<Vec3d> centres;
  for (const Lamp& lamp : lamps) {
    const auto others = std::ranges::count_if(lamps, [&](const Lamp& other) { return at_one_place(lamp, other); }) - 1;
    centres.push_back(lamp.axis && others > 0 ? vec::add(lamp.centre, vec::scale(*lamp.axis, 1.01 * lamp.size))
                                              : lamp.centre);
  }
  for (std::size_t i = 0; i < lamps.size(); ++i) lamps[i].centre = centres[i];
}

}  // namespace

void add_gltf_lights(const GltfObject& root, std::span<const GltfLight> lights, double size, GltfUnits units,
                     ImportedMesh& mesh, Notices& notices) {
  std::vector<Lamp> lamps;
  for (const GltfLight& light : lights) {
    const GltfObject object = root.extension("KHR_lights_punctual")->element("lights", light.number, "light");
    auto lamp = lamp_of(object, light, size, units, mesh, notices);
    if (!lamp) continue;
    const auto same = lamps.size() > kMostPaired
                          ? lamps.end()
                          : std::ranges::find_if(lamps, [&](const Lamp& other) { return shine_alike(other, *lamp); });
    if (same == lamps.end())
      lamps.push_back(std::move(*lamp));
    else
      same->power = vec::add(same->power, lamp->power);
  }
  keep_apart(lamps);
  for (const Lamp& lamp : lamps) {
    const Body body = lamp.axis ? octagon(lamp.centre, *lamp.axis, lamp.size) : icosahedron(lamp.centre, lamp.size);
    // The mean projected area of a convex body is a quarter of its surface (A. Cauchy 1841).
    add_body(body, lamp.name, vec::scale(lamp.power, (lamp.axis ? 1 : 4) / body.area()), lamp.place, mesh);
  }
}

}  // namespace torolux
