// SPDX-License-Identifier: MIT
// Writes scenes/interior/interior.obj: a flat of three rooms with furniture. Metres, y up; the same bytes every time.
#include <algorithm>
#include <cstdint>

#include "scenes/tools/obj_writer.hpp"

namespace {

using scene_tools::ObjWriter;
using scene_tools::Point;

struct Box {
  Point low, high;
  bool holds(const Point& p) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (p[i] < low[i] || p[i] > high[i]) return false;
    return true;
  }
};

constexpr double kCeiling = 2.6;

/// The shell: everything is wall but these boxes of air. Windows are air that reaches the outside.
const std::vector<Box> kAir{
    {{0, 0, 0}, {5, kCeiling, 6}},        // living room
    {{5.15, 0, 0}, {9, kCeiling, 2.9}},   // study
    {{5.15, 0, 3.05}, {9, kCeiling, 6}},  // kitchen
    {{5, 0, 1.0}, {5.15, 2.1, 1.9}},      // door to the study
    {{5, 0, 3.9}, {5.15, 2.1, 4.9}},      // door to the kitchen
    {{-0.3, 0.9, 1.2}, {0, 2.2, 4.2}},    // windows
    {{6.3, 0.9, -0.3}, {8.1, 2.2, 0}},   {{9, 1.1, 4.0}, {9.3, 2.1, 5.2}},
};
const Box kOutline{{-0.3, 0, -0.3}, {9.3, kCeiling, 6.3}};

bool is_air(const Point& p) {
  return std::any_of(kAir.begin(), kAir.end(), [&p](const Box& box) { return box.holds(p); });
}

/// Of a wall, by the room before it.
std::string wall_material(const Point& air) {
  if (air[0] < 5) return air[0] < 0 ? "frame" : "wall_living";
  if (air[0] > 9 || air[2] < 0 || air[0] < 5.15) return "frame";
  return air[2] < 3 ? "wall_study" : "wall_kitchen";
}

std::string surface_material(const Point& air, std::size_t axis, bool outside, bool towards_high) {
  if (axis == 1 && outside) {
    if (towards_high) return "ceiling";
    return air[0] > 5.15 && air[2] > 3 ? "tiles" : "parquet";
  }
  return outside ? "daylight" : wall_material(air);
}

/// Every face between air and wall, once: closed, and without corners on edges.
void shell(ObjWriter& writer) {
  std::array<std::vector<double>, 3> lines;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    for (const Box& box : kAir) lines[axis].insert(lines[axis].end(), {box.low[axis], box.high[axis]});
    lines[axis].insert(lines[axis].end(), {kOutline.low[axis], kOutline.high[axis]});
    std::sort(lines[axis].begin(), lines[axis].end());
    lines[axis].erase(std::unique(lines[axis].begin(), lines[axis].end()), lines[axis].end());
  }
  std::array<std::size_t, 3> i{};
  for (i[0] = 0; i[0] + 1 < lines[0].size(); ++i[0])
    for (i[1] = 0; i[1] + 1 < lines[1].size(); ++i[1])
      for (i[2] = 0; i[2] + 1 < lines[2].size(); ++i[2]) {
        Point low{};
        Point high{};
        Point middle{};
        for (std::size_t a = 0; a < 3; ++a) {
          low[a] = lines[a][i[a]];
          high[a] = lines[a][i[a] + 1];
          middle[a] = (low[a] + high[a]) / 2;
        }
        if (!is_air(middle)) continue;
        for (std::size_t axis = 0; axis < 3; ++axis)
          for (const bool up : {false, true}) {
            Point beyond = middle;
            beyond[axis] = up ? high[axis] + 0.01 : low[axis] - 0.01;
            if (is_air(beyond)) continue;
            writer.material(surface_material(middle, axis, !kOutline.holds(beyond), up));
            const std::size_t u = (axis + 1) % 3;
            const std::size_t v = (axis + 2) % 3;
            std::vector<Point> corners(4, up ? high : low);
            corners[0][u] = corners[3][u] = low[u];
            corners[1][u] = corners[2][u] = high[u];
            corners[0][v] = corners[1][v] = low[v];
            corners[2][v] = corners[3][v] = high[v];
            if (up) std::reverse(corners.begin(), corners.end());
            writer.polygon(corners);
          }
      }
}

/// A small generator of our own: the same numbers everywhere.
class Dice {
 public:
  double between(double low, double high) {
    state_ = state_ * 6364136223846793005U + 1442695040888963407U;
    return low + (high - low) * static_cast<double>(state_ >> 33U) / 2147483648.0;
  }
  int below(int n) { return std::min(n - 1, static_cast<int>(between(0, n))); }

 private:
  std::uint64_t state_ = 20;
};

/// Furniture stands this much above the floor, so that no two surfaces share a plane.
constexpr double kFoot = 0.002;

void table(ObjWriter& writer, const Point& at, double length, double width, double height) {
  writer.material("oak");
  for (const double x : {-1.0, 1.0})
    for (const double z : {-1.0, 1.0}) {
      const double cx = at[0] + x * (length / 2 - 0.06);
      const double cz = at[2] + z * (width / 2 - 0.06);
      writer.box({cx - 0.03, kFoot, cz - 0.03}, {cx + 0.03, height - 0.035, cz + 0.03});
    }
  writer.box({at[0] - length / 2, height - 0.04, at[2] - width / 2}, {at[0] + length / 2, height, at[2] + width / 2});
}

void chair(ObjWriter& writer, double x, double z, double degrees, const std::string& seat) {
  const Point pivot{x, 0, z};
  writer.material("walnut");
  for (const double dx : {-0.19, 0.19}) {
    writer.box({x + dx - 0.018, kFoot, z + 0.17}, {x + dx + 0.018, 0.44, z + 0.206}, degrees, pivot);
    writer.box({x + dx - 0.018, kFoot, z - 0.206}, {x + dx + 0.018, 0.92, z - 0.17}, degrees, pivot);
  }
  for (const double y : {0.58, 0.70, 0.82})
    writer.box({x - 0.18, y, z - 0.2}, {x + 0.18, y + 0.06, z - 0.178}, degrees, pivot);
  writer.material(seat);
  writer.box({x - 0.22, 0.435, z - 0.165}, {x + 0.22, 0.475, z + 0.22}, degrees, pivot);
}

/// Against a wall that runs along x (its back towards -z): boards and books.
void bookshelf(ObjWriter& writer, double x, double z, double width, int boards, Dice& dice) {
  constexpr double depth = 0.28;
  constexpr double gap = 0.36;
  const double height = boards * gap + 0.03;
  writer.material("oak");
  writer.box({x, kFoot, z}, {x + 0.025, height, z + depth});
  writer.box({x + width - 0.025, kFoot, z}, {x + width, height, z + depth});
  for (int board = 0; board <= boards; ++board) {
    const double y = 0.05 + board * (height - 0.08) / boards;
    writer.material("oak");
    writer.box({x + 0.02, y, z + 0.005}, {x + width - 0.02, y + 0.022, z + depth - 0.005});
    if (board == boards) break;
    double left = x + 0.04;
    while (left < x + width * dice.between(0.75, 1.0) - 0.1) {
      const double thick = dice.between(0.022, 0.055);
      const double tall = dice.between(0.19, 0.29);
      const double deep = dice.between(0.15, 0.21);
      writer.material("book" + std::to_string(dice.below(6)));
      writer.box({left, y + 0.0235, z + 0.02}, {left + thick, y + 0.0235 + tall, z + 0.02 + deep});
      left += thick + dice.between(0.002, 0.004);
    }
  }
}

void sofa(ObjWriter& writer, double x, double z, double degrees) {
  const Point pivot{x, 0, z};
  writer.material("sofa");
  writer.box({x - 1.0, 0.08, z - 0.42}, {x + 1.0, 0.30, z + 0.42}, degrees, pivot);
  writer.box({x - 1.0, 0.31, z - 0.45}, {x + 1.0, 0.82, z - 0.24}, degrees, pivot);
  for (const double side : {-1.0, 0.85})
    writer.box({x + side, 0.305, z - 0.235}, {x + side + 0.15, 0.56, z + 0.4}, degrees, pivot);
  writer.material("cushion");
  for (const double left : {-0.84, 0.01})
    writer.box({x + left, 0.303, z - 0.232}, {x + left + 0.83, 0.44, z + 0.4}, degrees, pivot);
  writer.material("walnut");
  for (const double dx : {-0.9, 0.86})
    for (const double dz : {-0.36, 0.32})
      writer.box({x + dx, kFoot, z + dz}, {x + dx + 0.04, 0.085, z + dz + 0.04}, degrees, pivot);
}

/// A shade open below, and a shining disc inside it that faces down.
void pendant(ObjWriter& writer, double x, double y, double z, const std::string& light) {
  writer.material("metal");
  writer.box({x - 0.006, y + 0.19, z - 0.006}, {x + 0.006, kCeiling - 0.002, z + 0.006});
  writer.lathe({x, y, z}, {{0.20, 0}, {0.17, 0.09}, {0.05, 0.2}, {0, 0.2}}, 16);
  writer.material(light);
  std::vector<Point> disc;
  for (int s = 0; s < 8; ++s) {
    const double angle = 2 * std::numbers::pi * s / 8;
    disc.push_back({x + 0.12 * std::cos(angle), y + 0.06, z + 0.12 * std::sin(angle)});
  }
  writer.polygon(disc);
}

void vase(ObjWriter& writer, const Point& at, double size, const std::string& material, int segments) {
  writer.material(material);
  writer.lathe(at,
               {{0, 0.002},
                {0.30 * size, 0.002},
                {0.46 * size, 0.25 * size},
                {0.50 * size, 0.5 * size},
                {0.34 * size, 0.85 * size},
                {0.20 * size, 1.1 * size},
                {0.26 * size, 1.3 * size},
                {0.22 * size, 1.29 * size},
                {0.16 * size, 1.1 * size},
                {0.26 * size, 0.8 * size},
                {0.30 * size, 0.3 * size},
                {0, 0.1 * size}},
               segments);
}

void plant(ObjWriter& writer, double x, double z, Dice& dice) {
  writer.material("terracotta");
  writer.lathe({x, 0, z}, {{0, 0.002}, {0.13, 0.002}, {0.18, 0.3}, {0.16, 0.3}, {0.15, 0.26}, {0, 0.26}}, 20);
  writer.material("leaf");
  for (int leaf = 0; leaf < 60; ++leaf) {
    const double angle = dice.between(0, 2 * std::numbers::pi);
    const double reach = dice.between(0.15, 0.42);
    const double rise = dice.between(0.35, 1.0);
    const double wide = dice.between(0.02, 0.05);
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const Point root{x + 0.03 * c, 0.27, z + 0.03 * s};
    const Point left{x + 0.7 * reach * c - wide * s, 0.27 + rise, z + 0.7 * reach * s + wide * c};
    const Point right{x + 0.7 * reach * c + wide * s, 0.27 + rise, z + 0.7 * reach * s - wide * c};
    const Point tip{x + 1.2 * reach * c, 0.27 + 0.85 * rise, z + 1.2 * reach * s};
    writer.polygon({root, right, left});
    writer.polygon({left, right, tip});
  }
}

/// On the wall z = `z`, facing +z.
void picture_frame(ObjWriter& writer, double x, double y, double z, double width, double height,
                   const std::string& canvas) {
  writer.material("walnut");
  writer.box({x - width / 2, y - height / 2, z + 0.003}, {x + width / 2, y + height / 2, z + 0.025});
  writer.material(canvas);
  const double w = width / 2 - 0.04;
  const double h = height / 2 - 0.04;
  writer.polygon(
      {{x - w, y - h, z + 0.028}, {x + w, y - h, z + 0.028}, {x + w, y + h, z + 0.028}, {x - w, y + h, z + 0.028}});
}

void living_room(ObjWriter& writer, Dice& dice) {
  writer.group("living_room");
  writer.material("rug");
  writer.box({1.3, 0.002, 1.6}, {3.9, 0.012, 3.6});
  table(writer, {2.6, 0, 4.75}, 1.8, 0.9, 0.74);
  for (const double x : {2.1, 3.1}) {
    chair(writer, x, 4.15, 0, "cushion");
    chair(writer, x, 5.35, 180, "cushion");
  }
  chair(writer, 3.85, 4.75, -100, "cushion");
  sofa(writer, 2.6, 0.75, 0);
  writer.material("oak");
  writer.box({2.0, 0.35, 2.2}, {3.2, 0.39, 2.9});
  writer.material("metal");
  writer.box({2.5, 0.014, 2.45}, {2.7, 0.355, 2.65});
  for (int i = 0; i < 3; ++i) {
    writer.material("book" + std::to_string(i));
    writer.box({2.1, 0.392 + 0.031 * i, 2.35}, {2.32, 0.42 + 0.031 * i, 2.62}, 12.0 * i, {2.2, 0, 2.5});
  }
  vase(writer, {2.9, 0.39, 2.5}, 0.22, "porcelain", 24);
  vase(writer, {2.6, 0.74, 4.75}, 0.2, "glaze", 24);
  writer.material("porcelain");
  for (const double x : {2.1, 3.1})
    for (const double z : {4.5, 5.0})
      writer.lathe({x, 0.741, z}, {{0, 0.001}, {0.07, 0.001}, {0.13, 0.02}, {0.12, 0.02}, {0.06, 0.008}, {0, 0.008}},
                   20);
  bookshelf(writer, 0.25, 0.03, 1.2, 5, dice);
  bookshelf(writer, 3.7, 0.03, 1.2, 5, dice);
  plant(writer, 4.6, 5.55, dice);
  plant(writer, 0.45, 5.2, dice);
  picture_frame(writer, 2.6, 1.65, 0, 1.1, 0.8, "canvas");
  pendant(writer, 2.2, 1.75, 4.75, "lamp");
  pendant(writer, 3.0, 1.75, 4.75, "lamp");
}

void study(ObjWriter& writer, Dice& dice) {
  writer.group("study");
  table(writer, {7.2, 0, 0.5}, 1.5, 0.7, 0.74);
  chair(writer, 7.2, 1.05, 170, "sofa");
  writer.material("metal");
  writer.box({6.95, 0.742, 0.4}, {7.25, 0.752, 0.6});
  writer.box({6.95, 0.755, 0.37}, {7.25, 0.965, 0.378});
  bookshelf(writer, 5.3, 0.03, 0.9, 6, dice);
  writer.material("mirror");
  writer.polygon({{8.99, 0.6, 1.0}, {8.99, 0.6, 2.0}, {8.99, 2.0, 2.0}, {8.99, 2.0, 1.0}});
  writer.material("cushion");
  writer.box({6.2, 0.012, 2.0}, {8.4, 0.4, 2.8});
  vase(writer, {7.7, 0.742, 0.45}, 0.16, "terracotta", 20);
  pendant(writer, 7.1, 2.0, 1.5, "lamp");
}

void kitchen(ObjWriter& writer) {
  writer.group("kitchen");
  writer.material("cabinet");
  for (int i = 0; i < 5; ++i) {
    const double x = 5.6 + 0.62 * i;
    writer.box({x, 0.1, 5.42}, {x + 0.6, 0.86, 5.98});
    writer.box({x, 1.5, 5.65}, {x + 0.6, 2.2, 5.98});
  }
  writer.material("metal");
  for (int i = 0; i < 5; ++i) {
    const double x = 5.6 + 0.62 * i;
    writer.box({x + 0.2, 0.76, 5.39}, {x + 0.4, 0.775, 5.405});
    writer.box({x + 0.2, 1.55, 5.62}, {x + 0.4, 1.565, 5.635});
  }
  writer.material("stone");
  writer.box({5.55, 0.87, 5.38}, {8.75, 0.91, 5.985});
  writer.material("porcelain");
  for (int i = 0; i < 4; ++i)
    writer.lathe({6.0 + 0.25 * i, 0.911, 5.7},
                 {{0, 0.001}, {0.04, 0.001}, {0.045, 0.1}, {0.04, 0.1}, {0.036, 0.01}, {0, 0.01}}, 16);
  table(writer, {7.1, 0, 4.15}, 1.1, 0.8, 0.74);
  chair(writer, 6.3, 4.15, 90, "glaze");
  chair(writer, 7.9, 4.15, -80, "glaze");
  writer.material("fruit");
  for (int i = 0; i < 3; ++i) {
    const double angle = 2 * std::numbers::pi * i / 3;
    std::vector<std::array<double, 2>> ball;
    for (int k = 0; k <= 8; ++k) {
      const double up = std::numbers::pi * k / 8;
      ball.push_back({k == 0 || k == 8 ? 0.0 : 0.045 * std::sin(up), 0.046 - 0.045 * std::cos(up)});
    }
    writer.lathe({7.1 + 0.055 * std::cos(angle), 0.741, 4.15 + 0.055 * std::sin(angle)}, ball, 14);
  }
  pendant(writer, 7.1, 1.7, 4.15, "lamp");
}

}  // namespace

int main() {
  std::printf("# Made by scenes/tools/make_interior.cpp.\n");
  ObjWriter writer("interior.mtl");
  Dice dice;
  writer.group("shell");
  shell(writer);
  living_room(writer, dice);
  study(writer, dice);
  kitchen(writer);
  return 0;
}
