// SPDX-License-Identifier: MIT
// Writes scenes/glossy_floor/glossy_floor.obj: a gallery with a polished floor, three pedestals and what stands on
// them. Metres; the lights are in scene.toml.
#include "scenes/tools/unit_sphere.hpp"

namespace {

using scene_tools::ObjWriter;
using scene_tools::Point;
using Ring = std::array<double, 2>;  // radius, height

constexpr double kWidth = 6;
constexpr double kHeight = 3;
constexpr double kDepth = 6;

/// Fronts inside.
void room(ObjWriter& writer) {
  writer.group("room");
  const auto at = [](int x, int y, int z) -> Point { return {x * kWidth, y * kHeight, z * kDepth}; };
  writer.material("floor");
  writer.polygon({at(0, 0, 0), at(0, 0, 1), at(1, 0, 1), at(1, 0, 0)});
  writer.material("ceiling");
  writer.polygon({at(0, 1, 0), at(1, 1, 0), at(1, 1, 1), at(0, 1, 1)});
  writer.material("back_wall");
  writer.polygon({at(0, 0, 0), at(1, 0, 0), at(1, 1, 0), at(0, 1, 0)});
  writer.material("wall");
  writer.polygon({at(0, 0, 1), at(0, 1, 1), at(1, 1, 1), at(1, 0, 1)});
  writer.polygon({at(0, 0, 0), at(0, 1, 0), at(0, 1, 1), at(0, 0, 1)});
  writer.material("coloured_wall");
  writer.polygon({at(1, 0, 0), at(1, 0, 1), at(1, 1, 1), at(1, 1, 0)});
}

void pedestal(ObjWriter& writer, double x, double z, double height, double degrees) {
  writer.material("pedestal");
  // The floor goes on below it; it floats by a hair, so that nothing lies in one plane.
  writer.box({x - 0.25, 0.001, z - 0.25}, {x + 0.25, height, z + 0.25}, degrees, {x, 0, z});
}

/// A profile turned about the vertical, with normals of the smooth surface.
void turned(ObjWriter& writer, const Point& base, const std::vector<Ring>& profile, int segments) {
  const auto angle = [segments](int s) { return 2 * std::numbers::pi * s / segments; };
  std::vector<Ring> slope(profile.size());  // of the normal: outwards, upwards
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Ring& before = profile[i == 0 ? 0 : i - 1];
    const Ring& after = profile[i + 1 == profile.size() ? i : i + 1];
    const double radial = after[0] - before[0];
    const double up = after[1] - before[1];
    const double length = std::hypot(radial, up);
    slope[i] = {up / length, -radial / length};
  }
  std::vector<std::vector<int>> positions(profile.size());
  std::vector<std::vector<int>> normals(profile.size());
  for (std::size_t i = 0; i < profile.size(); ++i) {
    for (int s = 0; s < segments; ++s) {
      const double c = std::cos(angle(s));
      const double d = std::sin(angle(s));
      positions[i].push_back(
          writer.position({base[0] + profile[i][0] * c, base[1] + profile[i][1], base[2] + profile[i][0] * d}));
      normals[i].push_back(writer.normal({slope[i][0] * c, slope[i][1], slope[i][0] * d}));
    }
  }
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    for (int s = 0; s < segments; ++s) {
      const auto a = static_cast<std::size_t>(s);
      const auto b = static_cast<std::size_t>((s + 1) % segments);
      writer.face({positions[i][a], positions[i + 1][a], positions[i + 1][b], positions[i][b]},
                  {normals[i][a], normals[i + 1][a], normals[i + 1][b], normals[i][b]});
    }
  }
}

void vase(ObjWriter& writer, const Point& base) {
  writer.material("vase");
  std::vector<Ring> profile;
  constexpr int kRings = 16;
  for (int i = 0; i <= kRings; ++i) {
    const double h = static_cast<double>(i) / kRings;
    const double radius =
        0.075 + 0.11 * std::sin(std::numbers::pi * std::pow(h, 0.75)) * (1 - 0.45 * h) + 0.03 * std::pow(h, 8);
    profile.push_back({radius, 0.62 * h});
  }
  turned(writer, base, profile, 24);
  // Its bottom and its mouth are closed.
  writer.material("vase_mouth");
  std::vector<Point> bottom;
  std::vector<Point> mouth;
  for (int s = 0; s < 24; ++s) {
    const double a = 2 * std::numbers::pi * s / 24;
    const double r = profile.back()[0];
    bottom.push_back({base[0] + profile[0][0] * std::cos(a), base[1], base[2] + profile[0][0] * std::sin(a)});
    mouth.insert(mouth.begin(), {base[0] + r * std::cos(a), base[1] + 0.62, base[2] + r * std::sin(a)});
  }
  writer.polygon(bottom);
  writer.polygon(mouth);
}

}  // namespace

int main() {
  std::printf("# Made by scenes/tools/make_glossy_floor.cpp.\n");
  ObjWriter writer("glossy_floor.mtl");
  room(writer);
  writer.group("left");
  pedestal(writer, 1.75, 3.0, 0.6, 20);
  writer.material("red");
  scene_tools::sphere(writer, {1.75, 0.905, 3.0}, 0.3, 3);
  writer.group("middle");
  pedestal(writer, 3.0, 2.1, 0.8, 0);
  vase(writer, {3.0, 0.802, 2.1});
  writer.group("right");
  pedestal(writer, 4.2, 3.1, 0.45, -25);
  writer.material("brass");
  scene_tools::sphere(writer, {4.2, 0.785, 3.1}, 0.33, 3);
  return 0;
}
