// SPDX-License-Identifier: MIT
// The tables of scene.toml that make surfaces without a mesh ([[sphere]], [room], [[lamp]], ...) enter; shapes leave.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "host_tools/scene/shapes.hpp"
#include "host_tools/scene/toml_table.hpp"

namespace torolux {

/// One table: one shape, or a cylinder with its ends.
struct ShapeEntry {
  std::vector<Shape> parts;
  std::string title;                    ///< as in "[[sphere]]"
  std::optional<std::string> material;  ///< absent: none was named
  std::optional<std::uint32_t> edges;   ///< of a circle; absent: as the material asks for
  bool flip = false;
  Place place;
};

/// In the order of axes: x, y, z, each its lower and its upper end.
enum class Wall : std::uint8_t { left, right, floor, ceiling, back, front };
inline constexpr std::array<const char*, 6> kWallNames{"left", "right", "floor", "ceiling", "back", "front"};

struct RoomEntry {
  Vec3d corner{0, 0, 0}, size{0, 0, 0};
  std::array<std::optional<std::string>, 6> materials;  ///< of each wall
  std::array<bool, 6> open{};                           ///< that wall is not there
  Place place;
};

/// A lamp at a wall of the room: a rectangle, or a disc.
struct HungLamp {
  Wall wall;
  std::array<double, 2> size{0, 0};    ///< along the wall: x or z, and z or y; 0 where it is a disc; a measured lamp
                                       ///< with neither is as large as its file says
  double radius = 0;                   ///< of a disc
  std::array<double, 2> offset{0, 0};  ///< from the wall's centre
};

struct LampEntry {
  std::optional<HungLamp> hung;
  std::optional<Shape> shape;  ///< where it is not hung
  Vec3d colour{1, 1, 1};       ///< linear, of luminance 1
  std::optional<double> lumen;
  std::optional<Vec3d> radiance;   ///< [W/(m^2 sr)]; this or lumen is there, or it is measured
  std::optional<std::string> ies;  ///< file of a measured lamp
  std::optional<Vec3d> along;      ///< of a measured lamp: to where its turn begins
  std::optional<Vec3d> centre;     ///< of a measured lamp as large as its file says, where it is not hung
  Vec3d facing{0, -1, 0};          ///< likewise
  Place place;
};

/// All throw InputError with file and line: a key that is not known, a value of the wrong kind or out of its range.
ShapeEntry read_sphere(TomlTable table);
ShapeEntry read_box(TomlTable table);
ShapeEntry read_quad(TomlTable table);
ShapeEntry read_disc(TomlTable table);
ShapeEntry read_cylinder(TomlTable table);
ShapeEntry read_torus(TomlTable table);
RoomEntry read_room(TomlTable table, const toml::table& raw);
LampEntry read_lamp(TomlTable table);

/// The keys of a rectangle: a corner and two edges, or centre, size and the direction that it faces.
class RectangleKeys {
 public:
  explicit RectangleKeys(TomlTable& table);
  /// Throws InputError: neither all of the one kind nor all of the other; no direction, no area.
  std::array<Vec3d, 4> corners(const TomlTable& table) const;
  /// Any of centre, size and facing.
  const std::optional<Vec3d>& centre() const { return centre_; }
  const std::optional<std::array<double, 2>>& size() const { return size_; }
  const std::optional<Vec3d>& facing() const { return facing_; }

 private:
  std::optional<Vec3d> corner_, centre_, facing_;
  std::optional<std::array<Vec3d, 2>> edges_;
  std::optional<std::array<double, 2>> size_;
};

}  // namespace torolux
