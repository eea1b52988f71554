// SPDX-License-Identifier: MIT
// Writes scenes/textured_walls/textured_walls.obj: a room of brick, planks and plaster with a rug, crates and a
// painting. Metres; the lights are in scene.toml, the images come from make_textures.
#include "scenes/tools/obj_writer.hpp"

namespace {

using scene_tools::ObjWriter;
using scene_tools::Point;

constexpr double kWidth = 4.4;
constexpr double kHeight = 2.6;
constexpr double kDepth = 4.6;

/// Fronts inside. A period of brick is 0.5 m wide and 0.4 m high, one of planks 1.6 m long and 0.6 m wide.
void room(ObjWriter& writer) {
  writer.group("room");
  const Point x{kWidth, 0, 0};
  const Point y{0, kHeight, 0};
  const Point z{0, 0, kDepth};
  const Point back_z{0, 0, -kDepth};
  writer.material("brick");
  writer.textured({0, 0, 0}, x, y, kWidth / 0.5, kHeight / 0.4);
  writer.material("planks");
  writer.textured({0, 0, kDepth}, x, back_z, kWidth / 1.6, kDepth / 0.6);
  writer.material("plaster");
  writer.polygon({{0, 0, kDepth}, {0, 0, 0}, {0, kHeight, 0}, {0, kHeight, kDepth}});
  writer.polygon({{kWidth, 0, 0}, {kWidth, 0, kDepth}, {kWidth, kHeight, kDepth}, {kWidth, kHeight, 0}});
  writer.polygon({{kWidth, 0, kDepth}, {0, 0, kDepth}, {0, kHeight, kDepth}, {kWidth, kHeight, kDepth}});
  writer.material("ceiling");
  writer.textured({0, kHeight, 0}, x, z, 1, 1);
}

/// A box of planks about the vertical through its middle; boards run along its longer edges.
void crate(ObjWriter& writer, const Point& base, const Point& size, double degrees) {
  writer.material("crate");
  const double c = std::cos(degrees * std::numbers::pi / 180);
  const double s = std::sin(degrees * std::numbers::pi / 180);
  const Point u{c * size[0], 0, -s * size[0]};
  const Point v{0, size[1], 0};
  const Point w{s * size[2], 0, c * size[2]};
  const auto at = [&](double a, double b, double d) -> Point {
    return {base[0] + (a - 0.5) * u[0] + (d - 0.5) * w[0], base[1] + b * v[1],
            base[2] + (a - 0.5) * u[2] + (d - 0.5) * w[2]};
  };
  const auto back = [](const Point& p) -> Point { return {-p[0], -p[1], -p[2]}; };
  writer.textured(at(0, 0, 1), u, v, 0.6, 1);
  writer.textured(at(1, 0, 0), back(u), v, 0.6, 1);
  writer.textured(at(1, 0, 1), back(w), v, 0.6, 1);
  writer.textured(at(0, 0, 0), w, v, 0.6, 1);
  writer.textured(at(0, 1, 1), u, back(w), 0.6, 1);
  writer.textured(at(0, 0, 0), u, w, 0.6, 1);
}

void rug(ObjWriter& writer) {
  writer.group("rug");
  writer.material("rug");
  writer.textured({1.2, 0.004, 3.5}, {2.1, 0, 0}, {0, 0, -2.4}, 1, 1);
}

/// On the left wall, in a frame.
void painting(ObjWriter& writer) {
  writer.group("painting");
  writer.material("frame");
  writer.box({0.002, 1.05, 1.2}, {0.04, 1.95, 2.4});
  writer.material("painting");
  writer.textured({0.042, 1.12, 2.33}, {0, 0, -1.06}, {0, 0.76, 0}, 1, 1);
}

}  // namespace

int main() {
  std::printf("# Made by scenes/tools/make_textured_walls.cpp.\n");
  ObjWriter writer("textured_walls.mtl");
  room(writer);
  rug(writer);
  painting(writer);
  writer.group("crates");
  crate(writer, {3.55, 0.001, 0.75}, {0.8, 0.6, 0.8}, 12);
  crate(writer, {3.5, 0.602, 0.7}, {0.5, 0.45, 0.5}, -20);
  crate(writer, {2.75, 0.001, 0.55}, {0.5, 0.4, 0.5}, 30);
  writer.group("table");
  writer.material("table");
  writer.box({0.35, 0.7, 0.35}, {1.55, 0.745, 1.0});
  for (const double x : {0.4, 1.45})
    for (const double z : {0.4, 0.9}) writer.box({x, 0.001, z}, {x + 0.05, 0.699, z + 0.05});
  writer.material("pot");
  writer.lathe({0.8, 0.746, 0.65},
               {{0, 0}, {0.09, 0}, {0.14, 0.08}, {0.15, 0.17}, {0.11, 0.27}, {0.07, 0.31}, {0, 0.31}}, 20);
  return 0;
}
