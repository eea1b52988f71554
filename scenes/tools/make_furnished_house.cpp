// SPDX-License-Identifier: MIT
// A folder enters; leaves in it: scene.toml, OBJ and MTL of a house of twelve rooms with doorways between them, each
// with a lamp, a table, chairs, vases and a shelf of books: half a million triangles. The same bytes every time.
#include <cstdint>

#include "scenes/tools/made_scene.hpp"
#include "scenes/tools/obj_writer.hpp"

namespace {

using scene_tools::hash;
using scene_tools::ObjWriter;
using scene_tools::Point;
using Profile = std::vector<std::array<double, 2>>;

constexpr int kColumns = 4;  // of rooms, along x
constexpr int kRows = 3;     // along z
constexpr double kRoom = 5;  // metres
constexpr double kHeight = 2.8;
constexpr double kHalfWall = 0.06;
constexpr double kDoorWidth = 1.0;
constexpr double kDoorHeight = 2.1;

/// 0 to 1, the same for the same numbers.
double chance(std::uint32_t what, std::uint32_t which) {
  return hash(hash(0x4F75'5345U + what) + which) * 0x1p-32;
}

/// A turned leg: as thick as `radius` with rings around it.
Profile leg(double radius, double height, int rings) {
  Profile profile{{0, 0}};
  for (int i = 0; i <= rings; ++i) {
    const double t = static_cast<double>(i) / rings;
    profile.push_back({radius * (0.75 + 0.25 * std::cos(6 * std::numbers::pi * t)), height * t});
  }
  profile.push_back({0, height});
  return profile;
}

/// Round above and below.
Profile cushion(double radius, double height, int rings) {
  Profile profile{{0, 0}};
  for (int i = 1; i < rings; ++i) {
    const double angle = std::numbers::pi * (static_cast<double>(i) / rings - 0.5);
    profile.push_back({radius * std::sqrt(std::cos(angle)), height / 2 * (1 + std::sin(angle))});
  }
  profile.push_back({0, height});
  return profile;
}

/// With a belly and a neck, of 2 * rings rings: outside up, inside down.
Profile vase(double radius, double height, int rings, double belly) {
  Profile profile{{0, 0}};
  const auto outline = [&](double t) {
    return radius * (0.45 + 0.55 * std::sin(std::numbers::pi * (0.15 + belly * t)));
  };
  for (int i = 0; i <= rings; ++i) {
    const double t = static_cast<double>(i) / rings;
    profile.push_back({outline(t), height * t});
  }
  for (int i = rings; i > 0; --i) {
    const double t = static_cast<double>(i) / rings;
    profile.push_back({0.9 * outline(t), 0.02 * height + 0.97 * height * t});
  }
  profile.push_back({0, 0.02 * height});
  return profile;
}

/// A wall along an axis (0: x, 2: z) from `from`, as long as a room, with a doorway in its middle.
void wall(ObjWriter& writer, const Point& from, std::size_t axis, bool door) {
  const std::size_t across = 2 - axis;
  const auto part = [&](double begin, double end, double bottom, double top) {
    Point low = from;
    Point high = from;
    low[axis] += begin;
    high[axis] += end;
    low[1] += bottom;
    high[1] += top;
    low[across] -= kHalfWall;
    high[across] += kHalfWall;
    writer.box(low, high);
  };
  if (!door) return part(0, kRoom, 0, kHeight);
  const double left = (kRoom - kDoorWidth) / 2;
  part(0, left, 0, kHeight);
  part(left, left + kDoorWidth, kDoorHeight, kHeight);
  part(left + kDoorWidth, kRoom, 0, kHeight);
}

void walls(ObjWriter& writer) {
  writer.group("walls");
  writer.material("wall");
  for (int row = 0; row <= kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      wall(writer, {column * kRoom, 0, row * kRoom}, 0, row > 0 && row < kRows);
  for (int column = 0; column <= kColumns; ++column)
    for (int row = 0; row < kRows; ++row)
      wall(writer, {column * kRoom, 0, row * kRoom}, 2, column > 0 && column < kColumns);
  const double x = kColumns * kRoom;
  const double z = kRows * kRoom;
  writer.material("floor");
  writer.polygon({{0, 0, z}, {x, 0, z}, {x, 0, 0}, {0, 0, 0}});
  writer.material("ceiling");
  writer.polygon({{0, kHeight, 0}, {x, kHeight, 0}, {x, kHeight, z}, {0, kHeight, z}});
}

void chair(ObjWriter& writer, const Point& at) {
  writer.material("wood");
  for (const double dx : {-0.17, 0.17})
    for (const double dz : {-0.17, 0.17}) writer.lathe({at[0] + dx, at[1], at[2] + dz}, leg(0.025, 0.43, 16), 16);
  writer.material("cloth");
  writer.lathe({at[0], at[1] + 0.4301, at[2]}, cushion(0.24, 0.08, 24), 32);
}

void table(ObjWriter& writer, const Point& at, std::uint32_t room) {
  writer.material("wood");
  for (const double dx : {-0.6, 0.6})
    for (const double dz : {-0.35, 0.35}) writer.lathe({at[0] + dx, at[1], at[2] + dz}, leg(0.045, 0.71, 24), 24);
  writer.box({at[0] - 0.75, 0.7101, at[2] - 0.5}, {at[0] + 0.75, 0.75, at[2] + 0.5});
  writer.material("china");
  for (std::uint32_t i = 0; i < 6; ++i) {
    const double x = at[0] - 0.55 + 0.22 * i;
    writer.lathe({x, 0.7502, at[2] + 0.3 * chance(room, i) - 0.15},
                 vase(0.05 + 0.04 * chance(room, 10 + i), 0.12 + 0.2 * chance(room, 20 + i), 13, 0.7), 32);
  }
}

void shelf(ObjWriter& writer, const Point& at, std::uint32_t room) {
  std::uint32_t book = 0;
  for (int board = 0; board < 4; ++board) {
    const double bottom = 0.4 + 0.45 * board;
    writer.material("wood");
    writer.box({at[0], bottom, at[2]}, {at[0] + 1.8, bottom + 0.03, at[2] + 0.3});
    double x = at[0] + 0.03;
    for (int i = 0; i < 30; ++i, ++book) {
      const double width = 0.02 + 0.02 * chance(room, 100 + book);
      writer.material("book_" + std::to_string(book % 3));
      writer.box({x, bottom + 0.0301, at[2] + 0.02},
                 {x + width, bottom + 0.2 + 0.1 * chance(room, 300 + book), at[2] + 0.22});
      x += width + 0.002;
    }
    if (board % 2 != 0) continue;
    writer.material("china");
    for (std::uint32_t i = 0; i < 3; ++i)
      writer.lathe({at[0] + 1.25 + 0.2 * i, bottom + 0.0302, at[2] + 0.15},
                   vase(0.07, 0.2 + 0.1 * chance(room, 500 + 10U * static_cast<std::uint32_t>(board) + i), 13, 0.8),
                   32);
  }
}

void furnish(ObjWriter& writer, int column, int row) {
  const auto room = static_cast<std::uint32_t>(row * kColumns + column);
  writer.group("room_" + std::to_string(room));
  const Point middle{(column + 0.5) * kRoom, 0, (row + 0.5) * kRoom};
  const Point at{middle[0] + 0.8 * chance(room, 1000) - 0.4, 0.0001, middle[2] + 0.8 * chance(room, 1001) - 0.4};
  table(writer, at, room);
  for (const double dx : {-0.4, 0.4})
    for (const double dz : {-0.85, 0.85}) chair(writer, {at[0] + dx, at[1], at[2] + dz});
  shelf(writer, {column * kRoom + kHalfWall + 0.2, 0, row * kRoom + kHalfWall + 0.01}, room);
}

void write_mesh() {
  std::printf("# Made by scenes/tools/make_furnished_house.cpp.\n");
  ObjWriter writer("furnished_house.mtl");
  walls(writer);
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column) furnish(writer, column, row);
}

void write_materials() {
  std::printf(
      "# Reflectances.\n"
      "newmtl wall\nKd 0.75 0.74 0.70\nnewmtl ceiling\nKd 0.80 0.80 0.80\nnewmtl floor\nKd 0.40 0.30 0.20\n"
      "newmtl wood\nKd 0.45 0.28 0.15\nnewmtl cloth\nKd 0.25 0.30 0.50\nnewmtl china\nKd 0.75 0.72 0.65\n"
      "newmtl book_0\nKd 0.55 0.15 0.12\nnewmtl book_1\nKd 0.15 0.30 0.18\nnewmtl book_2\nKd 0.60 0.50 0.30\n");
}

void write_scene() {
  std::printf(
      "# A house of twelve rooms: made by scenes/tools/make_furnished_house.cpp. Metres.\n"
      "name = \"furnished_house\"\n\n[[mesh]]\nfile = \"furnished_house.obj\"\n\n");
  for (int row = 0; row < kRows; ++row)
    for (int column = 0; column < kColumns; ++column)
      std::printf(
          "[[light]]\ncentre = [%.1f, 2.75, %.1f]\nsize = [0.8, 0.8]\nfacing = [0.0, -1.0, 0.0]\n"
          "radiance = [12.0, 11.0, 9.5]\n\n",
          (column + 0.5) * kRoom, (row + 0.5) * kRoom);
  std::printf("[camera]\neye = [9.6, 1.6, 9.6]\nlook_at = [6.5, 0.7, 6.4]\nfov = 60.0\n");
}

}  // namespace

int main(int count, char** words) {
  return scene_tools::make_scene(count, words, "furnished_house", {write_mesh, write_materials, write_scene});
}
