// SPDX-License-Identifier: MIT
// Reads shapes, the room and lamps of scene.toml.
#include "host_tools/scene/shape_entries.hpp"

#include <algorithm>
#include <cmath>

#include "emulator/nearest_name.hpp"
#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/rotation.hpp"

namespace torolux {
namespace {

constexpr double kMost = kMostCoordinate;
constexpr double kLeastLength = 1e-15;

std::array<Vec3d, 4> rectangle(const Vec3d& corner, const Vec3d& u, const Vec3d& v) {
  return {corner, vec::add(corner, u), vec::add(vec::add(corner, u), v), vec::add(corner, v)};
}

/// The width lies level; for a rectangle that faces up or down along x.
std::array<Vec3d, 4> facing_rectangle(const Vec3d& centre, const std::array<double, 2>& size, const Vec3d& facing) {
  const Vec3d normal = vec::unit(facing);
  const Vec3d aside = std::abs(normal[1]) > 0.999 ? Vec3d{0, 0, 1} : Vec3d{0, 1, 0};
  const Vec3d u = vec::scale(vec::unit(vec::cross(aside, normal)), size[0]);
  const Vec3d v = vec::scale(vec::cross(normal, vec::unit(u)), size[1]);
  return rectangle(vec::subtract(centre, vec::scale(vec::add(u, v), 0.5)), u, v);
}

double radius(TomlTable& table, const char* key) {
  return table.required(table.number(key, kLeastLength, kMost), key);
}

Vec3d point(TomlTable& table, const char* key) {
  return table.required(table.triple(key, -kMost, kMost, false), key);
}

void check_direction(const TomlTable& table, const char* key, const Vec3d& value) {
  if (!(vec::length(value) > 0))
    refuse(table.place(key), table.title() + " '" + std::string(key) + "' is zero: no direction");
}

Vec3d direction(TomlTable& table, const char* key) {
  const Vec3d value = point(table, key);
  check_direction(table, key, value);
  return value;
}

/// material and flip; with `round` also edges.
ShapeEntry begin(TomlTable& table, bool round) {
  ShapeEntry entry;
  entry.title = table.title();
  entry.place = table.place();
  entry.material = table.text("material");
  entry.flip = table.flag("flip").value_or(false);
  if (round)
    if (const auto edges = table.integer("edges", 8, 512)) entry.edges = static_cast<std::uint32_t>(*edges);
  return entry;
}

Wall wall_of(const TomlTable& table, const std::string& key, const std::string& text,
             const std::vector<std::string>& names) {
  const auto found = std::ranges::find(names, text);
  if (found == names.end())
    refuse(table.place(key), table.title() + " '" + key + "': " + no_such_name(text, "no wall", names));
  return static_cast<Wall>(found - names.begin());
}

/// Linear, of luminance 1.
Vec3d lamp_colour(TomlTable& table) {
  const auto colour = table.triple("colour", 0, kMost, false);
  const auto kelvin = table.number("kelvin", 1000, 1e6);
  if (colour && kelvin) refuse(table.place(), "[[lamp]] has both 'colour' and 'kelvin'; one of them says its colour");
  if (kelvin) return linear_colour(chromaticity(black_body(*kelvin)), 1).rgb;
  if (!colour) return {1, 1, 1};
  if (!(luminance(*colour) > 0)) refuse(table.place("colour"), "[[lamp]] 'colour' is black");
  return vec::scale(*colour, 1 / luminance(*colour));
}

void check_light(const TomlTable& table, const LampEntry& lamp) {
  if (lamp.ies && lamp.radiance)
    refuse(table.place("radiance"), "[[lamp]] 'ies' says how it shines; only 'lumen' may stand beside it");
  if (!lamp.ies && lamp.along) refuse(table.place("along"), "[[lamp]] 'along' turns a measured lamp; it needs 'ies'");
  if (lamp.along) check_direction(table, "along", *lamp.along);
  if (!lamp.ies && lamp.lumen.has_value() == lamp.radiance.has_value())
    refuse(lamp.place, "[[lamp]] needs either 'lumen' or 'radiance', or 'ies'");
}

Vec3d faces(const LampEntry& lamp) {
  if (lamp.hung) {
    Vec3d across{0, 0, 0};
    across[static_cast<std::size_t>(lamp.hung->wall) / 2] = 1;
    return across;
  }
  if (!lamp.shape) return lamp.facing;
  if (const auto* ring = std::get_if<Ring>(&*lamp.shape)) return ring->normal;
  const auto& corner = std::get<Quad>(*lamp.shape).corners;
  return vec::cross(vec::subtract(corner[1], corner[0]), vec::subtract(corner[3], corner[0]));
}

/// It turns the lamp about where it faces.
void check_along(const TomlTable& table, const LampEntry& lamp, const Vec3d& along) {
  constexpr double parallel = 1e-6;
  const Vec3d across = vec::cross(vec::unit(along), vec::unit(faces(lamp)));
  if (!(vec::length(across) > parallel))
    refuse(table.place("along"),
           "[[lamp]] 'along' lies along where the lamp faces: that does not turn it; give a direction across it");
}

}  // namespace

RectangleKeys::RectangleKeys(TomlTable& table)
    : corner_(table.triple("corner", -kMost, kMost, false)),
      centre_(table.triple("centre", -kMost, kMost, false)),
      facing_(table.triple("facing", -kMost, kMost, false)),
      edges_(table.two_vectors("edges", kMost)),
      size_(table.pair("size", 0, kMost)) {}

std::array<Vec3d, 4> RectangleKeys::corners(const TomlTable& table) const {
  std::array<Vec3d, 4> corners{};
  if (corner_ && edges_ && !centre_ && !size_ && !facing_) {
    corners = rectangle(*corner_, (*edges_)[0], (*edges_)[1]);
  } else if (centre_ && size_ && facing_ && !corner_ && !edges_) {
    check_direction(table, "facing", *facing_);
    corners = facing_rectangle(*centre_, *size_, *facing_);
  } else {
    refuse(table.place(), table.title() + " needs either 'corner' and 'edges', or 'centre', 'size' and 'facing'");
  }
  const Vec3d area = vec::cross(vec::subtract(corners[1], corners[0]), vec::subtract(corners[3], corners[0]));
  if (!(vec::length(area) > 0)) refuse(table.place(), table.title() + " has no area");
  return corners;
}

ShapeEntry read_sphere(TomlTable table) {
  ShapeEntry entry = begin(table, true);
  entry.parts.emplace_back(Sphere{point(table, "centre"), radius(table, "radius")});
  table.finish();
  return entry;
}

ShapeEntry read_box(TomlTable table) {
  ShapeEntry entry = begin(table, false);
  const Vec3d size = table.required(table.triple("size", kLeastLength, kMost, true), "size");
  const auto corner = table.triple("corner", -kMost, kMost, false);
  const auto centre = table.triple("centre", -kMost, kMost, false);
  const Vec3d turn = table.triple("rotate", -36000, 36000, false).value_or(Vec3d{0, 0, 0});
  table.finish();
  if (corner.has_value() == centre.has_value())
    refuse(table.place(), "[[box]] needs either 'corner' (the lowest in x, y and z) or 'centre'");
  const Vec3d half = vec::scale(size, 0.5);
  const Vec3d middle = centre ? *centre : vec::add(*corner, half);
  Box box{vec::subtract(middle, rotated(turn, half)), {}};
  if (corner && turn == Vec3d{0, 0, 0}) box.corner = *corner;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    Vec3d edge{0, 0, 0};
    edge[axis] = size[axis];
    box.edges[axis] = rotated(turn, edge);
  }
  entry.parts.emplace_back(box);
  return entry;
}

ShapeEntry read_quad(TomlTable table) {
  ShapeEntry entry = begin(table, false);
  const RectangleKeys keys(table);
  table.finish();
  entry.parts.emplace_back(Quad{keys.corners(table)});
  return entry;
}

ShapeEntry read_disc(TomlTable table) {
  ShapeEntry entry = begin(table, true);
  const Vec3d centre = point(table, "centre");
  const Vec3d facing = direction(table, "facing");
  const double outer = radius(table, "radius");
  const double inner = table.number("hole", 0, kMost).value_or(0);
  if (!(inner < outer)) refuse(table.place("hole"), "[[disc]] 'hole' is a radius below that of the disc");
  table.finish();
  entry.parts.emplace_back(Ring{centre, facing, inner, outer});
  return entry;
}

ShapeEntry read_cylinder(TomlTable table) {
  ShapeEntry entry = begin(table, true);
  const Vec3d from = point(table, "from");
  const Vec3d to = point(table, "to");
  const double lower = radius(table, "radius");
  const double upper = table.number("top_radius", 0, kMost).value_or(lower);
  const bool open = table.flag("open").value_or(false);
  table.finish();
  const Vec3d along = vec::subtract(to, from);
  if (!(vec::length(along) > 0)) refuse(table.place("to"), "[[cylinder]] 'from' and 'to' are one point");
  entry.parts.emplace_back(Cone{from, lower, to, upper});
  if (!open) entry.parts.emplace_back(Ring{from, vec::scale(along, -1), 0, lower});
  if (!open && upper > 0) entry.parts.emplace_back(Ring{to, along, 0, upper});
  return entry;
}

ShapeEntry read_torus(TomlTable table) {
  ShapeEntry entry = begin(table, true);
  const Vec3d centre = point(table, "centre");
  const Vec3d axis = direction(table, "axis");
  const double middle = radius(table, "radius");
  const double tube = radius(table, "tube");
  if (!(tube < middle)) refuse(table.place("tube"), "[[torus]] 'tube' is a radius below 'radius', that of its middle");
  table.finish();
  entry.parts.emplace_back(RingTorus{centre, axis, middle - tube, middle + tube});
  return entry;
}

RoomEntry read_room(TomlTable table, const toml::table& raw) {
  const std::vector<std::string> names(kWallNames.begin(), kWallNames.end());
  RoomEntry room;
  room.place = table.place();
  room.size = table.required(table.triple("size", kLeastLength, kMost, false), "size");
  room.corner = table.triple("corner", -kMost, kMost, false).value_or(Vec3d{0, 0, 0});
  const auto all = table.text("material");
  for (std::size_t i = 0; i < names.size(); ++i) {
    room.materials[i] = table.text(names[i]);
    if (!room.materials[i]) room.materials[i] = all;
  }
  table.known("open");
  table.finish();
  const toml::node* open = raw.get("open");
  if (open == nullptr) return room;
  const toml::array* list = open->as_array();
  if (list == nullptr) refuse(table.place("open"), "[room] 'open' must be a list of walls, as in [\"front\"]");
  for (const toml::node& name : *list) {
    const auto text = name.value<std::string>();
    if (!name.is_string() || !text) refuse(table.place("open"), "[room] 'open' must be a list of names");
    room.open[static_cast<std::size_t>(wall_of(table, "open", *text, names))] = true;
  }
  return room;
}

LampEntry read_lamp(TomlTable table) {
  LampEntry lamp;
  lamp.place = table.place();
  lamp.lumen = table.number("lumen", 1e-15, kMost);
  lamp.radiance = table.triple("radiance", 0, kMost, true);
  lamp.colour = lamp_colour(table);
  const auto at = table.text("at");
  const auto offset = table.pair("offset", -kMost, kMost);
  const auto radius = table.number("radius", kLeastLength, kMost);
  const RectangleKeys keys(table);
  lamp.ies = table.text("ies");
  lamp.along = table.triple("along", -kMost, kMost, false);
  table.finish();
  check_light(table, lamp);
  if (lamp.radiance && !(vec::largest(*lamp.radiance) > 0)) refuse(lamp.place, "[[lamp]] 'radiance' is zero");
  if (offset && !at) refuse(table.place("offset"), "[[lamp]] 'offset' is from the middle of a wall; it needs 'at'");
  if (at) {
    const std::vector<std::string> names{"on the left wall",  "on the right wall", "on the floor",
                                         "under the ceiling", "on the back wall",  "on the front wall"};
    const int sizes = (keys.size() ? 1 : 0) + (radius ? 1 : 0);
    if (sizes > 1 || (sizes == 0 && !lamp.ies) || keys.centre() || keys.facing())
      refuse(lamp.place, "[[lamp]] with 'at' needs either 'size' or 'radius', and no place of its own");
    lamp.hung = {wall_of(table, "at", *at, names), keys.size().value_or(std::array{0.0, 0.0}), radius.value_or(0),
                 offset.value_or(std::array{0.0, 0.0})};
  } else if (radius) {
    if (!keys.centre()) refuse(lamp.place, "[[lamp]] with a 'radius' needs a 'centre', or 'at'");
    if (keys.size()) refuse(lamp.place, "[[lamp]] has both 'radius' and 'size'");
    if (keys.facing()) check_direction(table, "facing", *keys.facing());
    if (keys.facing() || lamp.ies) {
      lamp.shape = Ring{*keys.centre(), keys.facing().value_or(lamp.facing), 0, *radius};
    } else {
      lamp.shape = Sphere{*keys.centre(), *radius};
    }
  } else if (lamp.ies && keys.centre() && !keys.size()) {
    lamp.centre = keys.centre();
    if (keys.facing()) check_direction(table, "facing", *keys.facing());
    lamp.facing = keys.facing().value_or(lamp.facing);
  } else {
    lamp.shape = Quad{keys.corners(table)};
  }
  if (lamp.along) check_along(table, lamp, *lamp.along);
  return lamp;
}

}  // namespace torolux
