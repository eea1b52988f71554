// SPDX-License-Identifier: MIT
// Makes an icosahedron of a point light, an octagon of a spot, and notes a sun. Bodies at one place stand so that none
// hides another.
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

/// What shines one way.
struct Lamp {
  std::string name;
  Place place;
  Vec3d centre;
  std::optional<Vec3d> axis;  ///< of a spot; unit
  Vec3d power;                ///< [W/sr]
};

/// Lamps at one place. Their bodies keep within a ball of this radius.
struct Site {
  Vec3d centre;
  std::vector<Lamp> lamps;
  double reach;
};

/// Absent: it does not shine, or is a sun, which is in `mesh` then.
std::optional<Lamp> lamp_of(const GltfObject& object, const GltfLight& light, GltfUnits units, ImportedMesh& mesh,
                            Notices& notices) {
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
  Lamp lamp{name, place, light.place.origin, std::nullopt, power};
  if (type == "spot") {
    notices.note(
        "a spot is a disc that has its intensity on the axis and falls off as the cosine: its cone is not rendered",
        place);
    lamp.axis = vec::scale(vec::unit(backwards), -1);
  }
  return lamp;
}

/// Fractions of a light's size. Nearer ones are at one place, the first's.
constexpr double kOnePlace = 0.15;
/// The least radius of a disc: 1/20,000 of a scene. Of smaller ones a PE's floats make other areas, or none.
constexpr double kLeastRadius = 0.01;
/// From a place to discs of spots; beside a point.
constexpr double kStand = 0.25, kStandBesidePoint = 0.5;
/// Pairs of places are looked at, of not more than these.
constexpr std::size_t kMostPaired = 2000;

std::vector<Site> sites_of(const std::vector<Lamp>& lamps, double size, Notices& notices) {
  std::vector<Site> sites;
  for (const Lamp& lamp : lamps) {
    const auto is_here = [&](const Site& site) {
      return vec::length(vec::subtract(site.centre, lamp.centre)) <= kOnePlace * size;
    };
    const auto here = sites.size() > kMostPaired ? sites.end() : std::ranges::find_if(sites, is_here);
    if (here == sites.end())
      sites.push_back({lamp.centre, {lamp}, size});
    else
      here->lamps.push_back(lamp);
  }
  if (sites.size() > kMostPaired) {
    notices.note("lights at more than " + std::to_string(kMostPaired) +
                     " places: those that are near to each other may hide each other",
                 sites.back().lamps.front().place);
    return sites;
  }
  for (Site& site : sites) {
    for (const Site& other : sites)
      if (&site != &other)
        site.reach = std::min(site.reach, 0.49 * vec::length(vec::subtract(site.centre, other.centre)));
  }
  return sites;
}

double angle_between(const Vec3d& a, const Vec3d& b) {
  return std::atan2(vec::length(vec::cross(a, b)), vec::dot(a, b));
}

/// Whether the other was joined to the first. Cosines about two axes add up to one about their weighted mean, but for
/// directions that only one of them reaches. turn: from which on spots are two.
bool join(Lamp& lamp, const Lamp& other, double turn, Notices& notices) {
  constexpr double told = 0.1 * std::numbers::pi / 180;
  if (lamp.axis.has_value() != other.axis.has_value()) return false;
  if (lamp.axis) {
    const double angle = angle_between(*lamp.axis, *other.axis);
    if (angle >= turn) return false;
    if (angle > told)
      notices.note("spots at one place that hardly turn from each other are one, along their mean", other.place);
    lamp.axis = vec::unit(
        vec::add(vec::scale(*lamp.axis, vec::sum(lamp.power)), vec::scale(*other.axis, vec::sum(other.power))));
  }
  lamp.power = vec::add(lamp.power, other.power);
  return true;
}

/// Of the turn between two spots, what half of a disc takes of it as seen from their place.
constexpr double kShareOfTurn = 0.49;

void join_alike(Site& site, double size, Notices& notices) {
  // 4.7 degrees, more where another place is near: discs that turn by less would be too small.
  const double turn = std::atan(kLeastRadius * size / std::min(site.reach, kStand * size)) / kShareOfTurn;
  std::vector<Lamp>& lamps = site.lamps;
  for (std::size_t before = lamps.size() + 1; before != lamps.size();) {
    before = lamps.size();
    for (std::size_t i = 0; i < lamps.size(); ++i) {
      const auto after = lamps.begin() + static_cast<std::ptrdiff_t>(i) + 1;
      const auto gone =
          std::remove_if(after, lamps.end(), [&](const Lamp& other) { return join(lamps[i], other, turn, notices); });
      lamps.erase(gone, lamps.end());
    }
  }
}

/// Radii of discs of spots over their common distance from the centre. Each disc lies in a cone of its own: none has a
/// part before another's plane, so that none hides another. widest: of the discs beside a point.
std::vector<double> slopes_of(const std::vector<Lamp>& lamps, double widest) {
  std::vector<double> slopes;
  for (const Lamp& lamp : lamps) {
    double least = std::numbers::pi / 2;
    for (const Lamp& other : lamps)
      if (&other != &lamp && lamp.axis && other.axis) least = std::min(least, angle_between(*lamp.axis, *other.axis));
    slopes.push_back(lamp.axis ? std::min(widest, std::tan(kShareOfTurn * least)) : 0);
  }
  return slopes;
}

void add_lamp(const Lamp& lamp, const Body& body, ImportedMesh& mesh) {
  // The mean projected area of a convex body is a quarter of its surface (A. Cauchy 1841).
  add_body(body, lamp.name, vec::scale(lamp.power, (lamp.axis ? 1 : 4) / body.area()), lamp.place, mesh);
}

void add_site(const Site& site, double size, ImportedMesh& mesh) {
  if (site.lamps.size() == 1) {
    const Lamp& lamp = site.lamps.front();
    add_lamp(lamp, lamp.axis ? octagon(site.centre, *lamp.axis, site.reach) : icosahedron(site.centre, site.reach),
             mesh);
    return;
  }
  const auto spots =
      static_cast<double>(std::ranges::count_if(site.lamps, [](const Lamp& lamp) { return !!lamp.axis; }));
  const bool point = spots < static_cast<double>(site.lamps.size());
  const double stand = std::min(site.reach, (point ? kStandBesidePoint : kStand) * size);
  // All discs together hide some 1/400 of a point's body, more where they would be too small.
  const double widest = point ? std::max(0.05 / std::sqrt(spots), kLeastRadius * size / stand) : 1;
  const std::vector<double> slopes = slopes_of(site.lamps, widest);
  const double steepest = *std::ranges::max_element(slopes);
  const double distance = std::min(stand, site.reach / std::sqrt(1 + steepest * steepest));
  for (std::size_t i = 0; i < site.lamps.size(); ++i) {
    const Lamp& lamp = site.lamps[i];
    if (lamp.axis) {
      const Vec3d centre = vec::add(site.centre, vec::scale(*lamp.axis, distance));
      add_lamp(lamp, octagon(centre, *lamp.axis, distance * slopes[i]), mesh);
    } else {
      add_lamp(lamp, icosahedron(site.centre, 0.99 * distance), mesh);
    }
  }
}

}  // namespace

void add_gltf_lights(const GltfObject& root, std::span<const GltfLight> lights, double size, GltfUnits units,
                     ImportedMesh& mesh, Notices& notices) {
  std::vector<Lamp> lamps;
  for (const GltfLight& light : lights) {
    const GltfObject object = root.extension("KHR_lights_punctual")->element("lights", light.number, "light");
    auto lamp = lamp_of(object, light, units, mesh, notices);
    if (lamp) lamps.push_back(std::move(*lamp));
  }
  for (Site& site : sites_of(lamps, size, notices)) {
    join_alike(site, size, notices);
    add_site(site, size, mesh);
  }
}

}  // namespace torolux
