// SPDX-License-Identifier: MIT
// Shapes are written as OBJ text and loaded like any scene, discs as polygons of the same area. A render of 4 x 4
// pixels tells absorbed and emitted energy.
#include "tests/support/form_factor_cases.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "tests/references/form_factors.hpp"
#include "tests/support/memory_files.hpp"

namespace torolux::test {
namespace {

using references::Rectangle;
using references::Vec;

/// An OBJ file, face by face.
class Shapes {
 public:
  void use(const char* material) { text_ += std::string("usemtl ") + material + "\n"; }
  /// Counter-clockwise seen from the front.
  void face(const std::vector<Vec>& corners) {
    for (const Vec& corner : corners) {
      text_ += "v";
      for (int axis = 0; axis < 3; ++axis) text_ += " " + number(corner[axis]);
      text_ += "\n";
    }
    text_ += "f";
    for (std::size_t i = 0; i < corners.size(); ++i)
      text_ += " " + std::to_string(static_cast<int>(i) - static_cast<int>(corners.size()));
    text_ += "\n";
  }
  /// Rings of quadrilaterals in the plane z, equal in area to the disc; facing up or down.
  void disc(double radius, double z, bool up) {
    constexpr int kSides = 64;
    constexpr int kRings = 4;
    const double turn = 2 * std::numbers::pi / kSides;
    const double reach = radius * std::sqrt(turn / std::sin(turn));
    const auto at = [&](int ring, int side) {
      const double angle = turn * (up ? side : -side);
      return Vec(reach * ring / kRings * std::cos(angle), reach * ring / kRings * std::sin(angle), z);
    };
    for (int side = 0; side < kSides; ++side) {
      face({Vec(0, 0, z), at(1, side), at(1, side + 1)});
      for (int ring = 1; ring < kRings; ++ring) {
        face({at(ring, side), at(ring + 1, side), at(ring + 1, side + 1), at(ring, side + 1)});
      }
    }
  }
  Scene scene(const std::string& name) const {
    MemoryFiles files({{"s.obj", "mtllib s.mtl\n" + text_},
                       {"s.mtl", "newmtl emitter\nKd 0 0 0\nKe 1 1 1\nnewmtl absorber\nKd 0 0 0\n"}});
    Scene result = load_scene_from(files, "s.obj", {});
    result.name = name;
    return result;
  }

 private:
  static std::string number(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.17g", value);
    return text.data();
  }
  std::string text_;
};

void floor(Shapes& shapes, const Rectangle& r) {
  shapes.face({{r.x0, r.y0, 0}, {r.x1, r.y0, 0}, {r.x1, r.y1, 0}, {r.x0, r.y1, 0}});
}

FormFactorCase parallel(const char* name, const Rectangle& from, const Rectangle& to, double z) {
  Shapes shapes;
  shapes.use("emitter");
  floor(shapes, from);
  shapes.use("absorber");
  shapes.face({{to.x0, to.y0, z}, {to.x0, to.y1, z}, {to.x1, to.y1, z}, {to.x1, to.y0, z}});
  return {name, references::parallel_rectangles(from, to, z), shapes.scene(name)};
}

FormFactorCase perpendicular(const char* name, const Rectangle& from, const Rectangle& to) {
  Shapes shapes;
  shapes.use("emitter");
  floor(shapes, from);
  shapes.use("absorber");
  shapes.face({{0, to.y0, to.x0}, {0, to.y1, to.x0}, {0, to.y1, to.x1}, {0, to.y0, to.x1}});
  return {name, references::perpendicular_rectangles(from, to), shapes.scene(name)};
}

FormFactorCase discs(const char* name, double r1, double r2, double h) {
  Shapes shapes;
  shapes.use("emitter");
  shapes.disc(r1, 0, true);
  shapes.use("absorber");
  shapes.disc(r2, h, false);
  return {name, references::coaxial_discs(r1, r2, h), shapes.scene(name)};
}

}  // namespace

std::vector<FormFactorCase> form_factor_cases() {
  const Rectangle unit{0, 1, 0, 1};
  return {parallel("squares_at_half", unit, unit, 0.5),
          parallel("squares_at_one", unit, unit, 1),
          parallel("squares_at_two", unit, unit, 2),
          parallel("squares_at_four", unit, unit, 4),
          parallel("rectangles_at_one", {0, 1, 0, 2}, {0, 1, 0, 2}, 1),
          parallel("rectangles_apart", {0, 1, 0, 0.5}, {0.5, 2, 1, 2}, 0.7),
          perpendicular("squares_at_an_edge", unit, unit),
          perpendicular("wide_to_high_at_an_edge", {0, 2, 0, 1}, unit),
          perpendicular("low_to_high_at_an_edge", unit, {0, 2, 0, 1}),
          perpendicular("perpendicular_apart", {0.5, 1.5, 0, 1}, {0.25, 1, 0.5, 2}),
          discs("discs_at_one", 1, 1, 1),
          discs("small_to_large_disc", 0.5, 1, 1),
          discs("large_to_small_disc", 1, 0.5, 0.5),
          discs("discs_far_apart", 0.5, 0.5, 2),
          parallel("point_under_the_middle", {0.4999, 0.5001, 0.4999, 0.5001}, unit, 1),
          parallel("point_under_a_corner", {0, 0.0002, 0, 0.0002}, unit, 1)};
}

double measured_form_factor(const FormFactorCase& shapes, const Quality& quality) {
  RenderCase squares = native_case({});
  squares.quality = quality;
  squares.quality.width = squares.quality.height = 4;
  squares.quality.samples = 1;
  squares.quality.unshot = 1e-6;
  squares.machine.subspaces = {4, 4, 4};
  const RenderResult result =
      render(shapes.scene, shapes.scene.camera.value(), squares.quality, squares.machine, {}, pe_image(), {});
  return result.figures.energy.absorbed[0] / result.figures.energy.emitted[0];
}

}  // namespace torolux::test
