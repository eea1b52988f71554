// SPDX-License-Identifier: MIT
// Proves which transparent materials of a material library are panes, which are solid glass, and which stay opaque.
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// A closed tetrahedron, its fronts outwards, its corners the four positions that come first.
const std::string kTetrahedron = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

Scene with(const std::string& material, const std::string& faces) {
  return load_texts({{"a.obj", "mtllib a.mtl\nusemtl m\n" + faces}, {"a.mtl", "newmtl m\n" + material}}, "a.obj");
}

TEST(Panes, OpenSheetsArePanes) {
  for (const char* material : {"Kd 1\nd 0.1\nillum 4\n", "Kd 1\nd 0.1\nillum 6\n", "Kd 1\nTr 0.9\nillum 9\n",
                               "Kd 1\nTf 0.5 0.9 1\nillum 4\n", "Kd 1\nd 0.2\n", "Kd 1\nd 0.2\nKs 0.5\nillum 2\n"}) {
    const Scene scene = with(material, kTriangle);
    ASSERT_EQ(scene.materials.size(), 1U);
    EXPECT_EQ(scene.materials[0].kind, SurfaceKind::glass) << material;
    EXPECT_TRUE(scene.materials[0].thin) << material;
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("open sheets is a pane, which does not bend light: 'm'")));
  }
}

TEST(Panes, ClosedBodiesAreSolidGlass) {
  const Scene scene = with("Kd 1\nd 0.1\nNi 1.4\nillum 4\n", kTetrahedron);
  EXPECT_EQ(scene.materials[0].kind, SurfaceKind::glass);
  EXPECT_FALSE(scene.materials[0].thin);
  EXPECT_DOUBLE_EQ(scene.materials[0].refractive_index, 1.4);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("closed bodies is solid glass: 'm'")));
}

// Programs reckon a seam's two sides apart: they differ in the last digits.
TEST(Panes, ABodyWithASeamIsClosed) {
  const Scene scene = with("Kd 1\nd 0.1\nillum 4\n",
                           "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nv 1e-16 1 2.4e-16\nv 1 1e-15 0\n"
                           "f 1 3 2\nf 1 6 4\nf 1 4 5\nf 2 3 4\n");
  EXPECT_FALSE(scene.materials[0].thin);
  EXPECT_EQ(scene.positions.size(), 4U);
}

TEST(Panes, AMaterialOfBothBecomesTwo) {
  const Scene scene = with("Kd 1\nd 0.1\nillum 4\n", kTetrahedron + "v 5 0 0\nv 6 0 0\nv 6 1 0\nf 5 6 7\n");
  ASSERT_EQ(scene.triangles.size(), 5U);
  ASSERT_EQ(scene.materials.size(), 2U);
  for (std::size_t t = 0; t < 5; ++t) EXPECT_EQ(scene.materials[scene.triangles[t].material].thin, t == 4);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("solid glass on closed bodies and a pane on open sheets: 'm'")));
}

TEST(Panes, ASheetThatStandsTwiceIsOnePane) {
  const Scene scene = with("Kd 1\nd 0.1\nillum 4\n", kTriangle + "f 3 2 1\n");
  EXPECT_EQ(scene.triangles.size(), 1U);
  EXPECT_TRUE(scene.materials[0].thin);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("a pane that stands twice")));
}

TEST(Panes, WhatPassesIsByCoverColourAndFilter) {
  const Scene scene = with("Kd 0 0.5 1\nd 0.4\nTf 1 1 0.5\nillum 9\n", kTriangle);
  EXPECT_NEAR(scene.materials[0].transmittance[0], 0.6, 1e-12);
  EXPECT_NEAR(scene.materials[0].transmittance[1], 0.8, 1e-12);
  EXPECT_NEAR(scene.materials[0].transmittance[2], 0.5, 1e-12);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("without an Ni of 0.2 to 5: 1.5 is taken")));
}

TEST(Panes, GlassByItsNameStaysSolid) {
  EXPECT_FALSE(with("Ni 1.5\nd 0.1\nillum 7\n", kTriangle).materials[0].thin);
}

TEST(Panes, WhatMayBeMeantOtherwiseIsOpaqueAndTold) {
  const auto opaque = [](const std::string& material, const std::string& told) {
    const Scene scene = with("Kd 0.5\n" + material, kTriangle);
    EXPECT_EQ(scene.materials[0].kind, SurfaceKind::diffuse) << material;
    EXPECT_THAT(scene.warnings, Contains(HasSubstr(told))) << material;
  };
  opaque("illum 4\nTf 1 1 1\n", "illum 4, 6 and 9 without d below 1");
  opaque("illum 4\nTf 0 0 0\n", "illum 4, 6 and 9 without d below 1");
  opaque("d 0.5\n", "half transparency is not rendered");
  opaque("Tr 1\n", "Tr 1 without d");
  opaque("Ke 1\nd 0.1\nillum 4\n", "of what emits");
  opaque("d 1.5\n", "not a number from 0 to 1 is not used: d 1.5");
}

TEST(Panes, SceneTomlDecides) {
  const auto load = [](const std::string& override) {
    return load_texts({{"a.obj", "mtllib a.mtl\nusemtl m\n" + kTriangle},
                       {"a.mtl", "newmtl m\nKd 1\nd 0.1\nillum 4\n"},
                       {"a.toml", "[[mesh]]\nfile = \"a.obj\"\n[material.m]\n" + override}},
                      "a.toml");
  };
  EXPECT_FALSE(load("glass = 1.5\n").materials[0].thin);
  EXPECT_TRUE(load("glass = 1.5\nthin = true\n").materials[0].thin);
  EXPECT_EQ(load("diffuse = 0.5\n").materials[0].kind, SurfaceKind::diffuse);
}

}  // namespace
}  // namespace torolux
