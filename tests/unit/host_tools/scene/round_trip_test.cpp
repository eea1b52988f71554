// SPDX-License-Identifier: MIT
// Proves on random meshes that what is written as OBJ is what is read: positions, faces, materials, in any spelling.
#include <cstdio>

#include "tests/unit/host_tools/scene/scene_text.hpp"
// After GoogleTest, which it does not include itself.
#include <rapidcheck/gtest.h>

namespace torolux {
namespace {

struct Triangle {
  std::array<Vec3d, 3> corner;
  int material;
};

std::string number(double value) {
  std::array<char, 40> text{};
  std::snprintf(text.data(), text.size(), *rc::gen::element("%.17g", "%+.17g", "%.17e"), value);
  return text.data();
}

double coordinate() {
  return *rc::gen::inRange(-1000000, 1000000) * 1e-3 + *rc::gen::inRange(0, 1000) * 1e-9;
}

std::string blank() {
  return *rc::gen::element<std::string>(" ", "  ", "\t", " \t ", " \\\n ");
}

RC_GTEST_PROP(ObjProperty, WhatIsWrittenIsRead, ()) {
  const int count = *rc::gen::inRange(1, 12);
  std::vector<Triangle> written;
  std::string text = *rc::gen::element<std::string>("mtllib a.mtl\n", "# made by a test\r\nmtllib a.mtl\r\n");
  int positions = 0;
  for (int t = 0; t < count; ++t) {
    Triangle triangle{{}, *rc::gen::inRange(0, 3)};
    for (Vec3d& corner : triangle.corner) {
      corner = {coordinate(), coordinate(), coordinate()};
      text += "v" + blank() + number(corner[0]) + blank() + number(corner[1]) + blank() + number(corner[2]) +
              *rc::gen::element<std::string>("\n", " # remark\n", "\r\n", " 1.0\n");
      ++positions;
    }
    const bool relative = *rc::gen::arbitrary<bool>();
    text += "usemtl m" + std::to_string(triangle.material) + "\nf";
    for (int corner = 0; corner < 3; ++corner)
      text += blank() + std::to_string(relative ? corner - 3 : positions - 2 + corner);
    text += "\n";
    written.push_back(triangle);
  }
  const std::string library = "newmtl m0\nKd 0.1\nnewmtl m1\nKd 0.2\nnewmtl m2\nKd 0.3\n";
  Scene scene;
  try {
    scene = load_texts({{"a.obj", text}, {"a.mtl", library}}, "a.obj");
  } catch (const InputError& error) {
    // Three random points on a line, and nothing else.
    RC_ASSERT(std::string(error.what()).find("no surface with an area") != std::string::npos);
    RC_DISCARD("no area");
  }
  RC_PRE(scene.triangles.size() == written.size());
  for (std::size_t t = 0; t < written.size(); ++t) {
    for (std::size_t corner = 0; corner < 3; ++corner)
      RC_ASSERT(scene.positions[scene.triangles[t].position[corner]] == written[t].corner[corner]);
    RC_ASSERT(scene.materials[scene.triangles[t].material].name == "m" + std::to_string(written[t].material));
  }
}

}  // namespace
}  // namespace torolux
