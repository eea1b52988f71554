// SPDX-License-Identifier: MIT
// A folder enters; leaves in it: scene.toml, OBJ and MTL of a room of 6 x 3 x 6 with a lamp under the ceiling and 1,000
// small boxes, most of them low in one corner. The scene by which the machine's scaling is measured (docs/scaling.md);
// the same bytes every time.
#include <cstdint>

#include "scenes/tools/made_scene.hpp"
#include "scenes/tools/obj_writer.hpp"

namespace {

using scene_tools::hash;
using scene_tools::ObjWriter;
using scene_tools::Point;

constexpr Point kRoom{6, 3, 6};  // metres
constexpr std::uint32_t kBoxes = 1000;
constexpr double kShortestEdge = 0.03;
constexpr double kLongestEdge = 0.11;
/// Of all boxes, in this part of the room; the others hang evenly about it.
constexpr double kInTheCorner = 0.85;
constexpr Point kCorner{2, 1, 2};
/// There a uniform number to this power, times the edge, is how far from the room's corner a box lies.
constexpr double kCrowding = 1.3;
/// Between a box and the room's walls, so that no faces lie in one plane.
constexpr double kClearance = 0.08;

/// 0 to 1, the same for the same numbers.
double chance(std::uint32_t box, std::uint32_t attempt, std::uint32_t what) {
  return hash(hash(hash(0x7060'1013U + box) + attempt) + what) * 0x1p-32;
}

struct Box {
  Point middle, half;
  double degrees = 0;
  double reach() const { return std::sqrt(half[0] * half[0] + half[1] * half[1] + half[2] * half[2]); }
};

bool apart(const Box& a, const Box& b) {
  double square = 0;
  for (std::size_t axis = 0; axis < 3; ++axis) square += std::pow(a.middle[axis] - b.middle[axis], 2);
  return square > std::pow(a.reach() + b.reach(), 2);
}

Box thrown(std::uint32_t number, std::uint32_t attempt) {
  Box box;
  const bool in_the_corner = chance(number, 0, 0) < kInTheCorner;
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    const double edge = kShortestEdge + (kLongestEdge - kShortestEdge) * chance(number, attempt, 1 + axis);
    const double at = chance(number, attempt, 4 + axis);
    box.half[axis] = edge / 2;
    const double from_wall =
        in_the_corner ? kCorner[axis] * std::pow(at, kCrowding) : (kRoom[axis] - 2 * kClearance) * at;
    box.middle[axis] = kClearance + from_wall;
  }
  box.degrees = 90 * chance(number, attempt, 7);
  return box;
}

/// None touches another: what overlaps is thrown again.
std::vector<Box> clutter() {
  std::vector<Box> boxes;
  for (std::uint32_t number = 0; number < kBoxes; ++number) {
    for (std::uint32_t attempt = 0;; ++attempt) {
      const Box box = thrown(number, attempt);
      bool free = true;
      for (const Box& other : boxes) free = free && apart(box, other);
      if (!free) continue;
      boxes.push_back(box);
      break;
    }
  }
  return boxes;
}

/// Fronts inside.
void room(ObjWriter& writer) {
  const auto [x, y, z] = kRoom;
  writer.group("room");
  writer.material("wall");
  writer.polygon({{0, 0, z}, {0, 0, 0}, {0, y, 0}, {0, y, z}});
  writer.polygon({{x, 0, 0}, {x, 0, z}, {x, y, z}, {x, y, 0}});
  writer.polygon({{0, 0, 0}, {x, 0, 0}, {x, y, 0}, {0, y, 0}});
  writer.polygon({{x, 0, z}, {0, 0, z}, {0, y, z}, {x, y, z}});
  writer.material("ceiling");
  writer.polygon({{0, y, 0}, {x, y, 0}, {x, y, z}, {0, y, z}});
  writer.material("floor");
  writer.polygon({{0, 0, z}, {x, 0, z}, {x, 0, 0}, {0, 0, 0}});
}

void write_mesh() {
  std::printf("# Made by scenes/tools/make_cluttered_room.cpp.\n");
  ObjWriter writer("cluttered_room.mtl");
  room(writer);
  writer.group("boxes");
  std::uint32_t number = 0;
  for (const Box& box : clutter()) {
    writer.material("box_" + std::to_string(number++ % 3));
    Point low{};
    Point high{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      low[axis] = box.middle[axis] - box.half[axis];
      high[axis] = box.middle[axis] + box.half[axis];
    }
    writer.box(low, high, box.degrees, box.middle);
  }
}

void write_materials() {
  std::printf(
      "# Reflectances.\n"
      "newmtl wall\nKd 0.70 0.70 0.68\nnewmtl ceiling\nKd 0.80 0.80 0.80\nnewmtl floor\nKd 0.45 0.40 0.35\n"
      "newmtl box_0\nKd 0.60 0.30 0.25\nnewmtl box_1\nKd 0.30 0.50 0.30\nnewmtl box_2\nKd 0.35 0.40 0.60\n");
}

void write_scene() {
  std::printf(
      "# A room with 1,000 small boxes, most of them in one corner: made by scenes/tools/make_cluttered_room.cpp. "
      "Metres.\n"
      "name = \"cluttered_room\"\n\n[[mesh]]\nfile = \"cluttered_room.obj\"\n\n"
      "[[light]]\ncentre = [3.0, 2.95, 3.0]\nsize = [1.0, 1.0]\nfacing = [0.0, -1.0, 0.0]\n"
      "radiance = [12.0, 11.5, 10.5]\n\n"
      "[camera]\neye = [3.6, 1.9, 3.9]\nlook_at = [0.55, 0.45, 0.6]\nfov = 50.0\n");
}

}  // namespace

int main(int count, char** words) {
  return scene_tools::make_scene(count, words, "cluttered_room", {write_mesh, write_materials, write_scene});
}
