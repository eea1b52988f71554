// SPDX-License-Identifier: MIT
// Proves how a material library is mapped to diffuse, mirror, glass and light, and what in it is refused.
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::StartsWith;

Scene with_material(const std::string& lines) {
  return load_texts({{"a.obj", "mtllib a.mtl\nusemtl m\n" + kTriangle}, {"a.mtl", "newmtl m\n" + lines}}, "a.obj");
}

std::string refused(const std::string& lines) {
  return refusal({{"a.obj", "mtllib a.mtl\nusemtl m\n" + kTriangle}, {"a.mtl", "newmtl m\n" + lines}}, "a.obj");
}

void expect_colour(const Vec3d& colour, double r, double g, double b) {
  // tinyobjloader's decimal numbers are off by an ulp or two.
  EXPECT_NEAR(colour[0], r, 1e-12);
  EXPECT_NEAR(colour[1], g, 1e-12);
  EXPECT_NEAR(colour[2], b, 1e-12);
}

TEST(Mtl, DiffuseLight) {
  const Scene scene = with_material("Kd 0.1 0.2 0.3 # comment\nKe 17 12 4\n");
  EXPECT_EQ(scene.materials[0].kind, SurfaceKind::diffuse);
  expect_colour(scene.materials[0].diffuse, 0.1, 0.2, 0.3);
  expect_colour(scene.materials[0].emission, 17, 12, 4);
  EXPECT_NO_THROW(check_renderable(scene));
}

TEST(Mtl, OneValueStandsForThree) {
  expect_colour(with_material("Kd 0.25\n").materials[0].diffuse, 0.25, 0.25, 0.25);
}

TEST(Mtl, Illum3And5WithKsAreMirrors) {
  for (const char* illum : {"3", "5"}) {
    const Scene scene = with_material(std::string("Kd 0.2 0.2 0.2\nKs 0.9 0.8 0.7\nillum ") + illum + "\n");
    EXPECT_EQ(scene.materials[0].kind, SurfaceKind::mirror);
    expect_colour(scene.materials[0].specular, 0.9, 0.8, 0.7);
    expect_colour(scene.materials[0].diffuse, 0, 0, 0);
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("its Kd is not used")));
  }
}

TEST(Mtl, MirrorWithoutKsIsDiffuse) {
  EXPECT_EQ(with_material("Kd 0.5 0.5 0.5\nillum 3\n").materials[0].kind, SurfaceKind::diffuse);
}

TEST(Mtl, KsOfADiffuseSurfaceIsTold) {
  for (const char* illum : {"", "illum 0\n", "illum 1\n"}) {
    const Scene scene = with_material(std::string("Kd 0.5 0.5 0.5\nKs 0.5 0.5 0.5\nNs 10\n") + illum);
    EXPECT_EQ(scene.materials[0].kind, SurfaceKind::diffuse);
    EXPECT_FALSE(is_glossy(scene.materials[0]));
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("Ks is used for glossy surfaces")));
  }
}

TEST(Mtl, Illum2WithKsIsGlossy) {
  const Scene scene = with_material("Kd 0.5 0.4 0.3\nKs 0 0.2 0.1\nNs 30\nillum 2\n");
  EXPECT_TRUE(is_glossy(scene.materials[0]));
  expect_colour(scene.materials[0].diffuse, 0.5, 0.4, 0.3);
  expect_colour(scene.materials[0].specular, 0, 0.2, 0.1);
  EXPECT_DOUBLE_EQ(scene.materials[0].exponent, 30);
  EXPECT_THAT(scene.warnings, testing::Not(Contains(HasSubstr("K"))));
  EXPECT_FALSE(is_glossy(with_material("Kd 0.5\nKs 0 0 0\nNs 30\nillum 2\n").materials[0]));
}

TEST(Mtl, GlossyWithoutNsIsToldAndIs1) {
  const Scene scene = with_material("Kd 0.5\nKs 0.2\nillum 2\n");
  EXPECT_DOUBLE_EQ(scene.materials[0].exponent, 1);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("without Ns")));
}

TEST(Mtl, DiffuseAndGlossyTogetherAreScaled) {
  const Scene scene = with_material("Kd 0.8 0.5 0.1\nKs 0.5 0.5 0.5\nNs 9\nillum 2\n");
  expect_colour(scene.materials[0].diffuse, 0.8 * 0.99 / 1.3, 0.5 * 0.99 / 1.3, 0.1 * 0.99 / 1.3);
  expect_colour(scene.materials[0].specular, 0.5 * 0.99 / 1.3, 0.5 * 0.99 / 1.3, 0.5 * 0.99 / 1.3);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("a.mtl:1: reflectances (Kd + Ks) of one or more")));
  EXPECT_THAT(with_material("Kd 0.7\nKs 0.29\nNs 9\nillum 2\n").warnings, testing::Not(Contains(HasSubstr("scaled"))));
}

TEST(Mtl, ABlenderMetalKeepsItsColour) {
  const Scene gold = with_material("Ns 250\nKa 1 1 1\nKd 0.9 0.6 0.2\nKs 0.5 0.5 0.5\nillum 3\n");
  EXPECT_EQ(gold.materials[0].kind, SurfaceKind::mirror);
  expect_colour(gold.materials[0].specular, 0.9, 0.6, 0.2);
  EXPECT_THAT(gold.warnings, Contains(HasSubstr("is a metal as Blender writes it")));
  // Where Ks has a colour of its own, or Kd has none, Ks counts.
  expect_colour(with_material("Kd 0.9 0.6 0.2\nKs 0.5 0.4 0.5\nillum 3\n").materials[0].specular, 0.5, 0.4, 0.5);
  expect_colour(with_material("Kd 0.8 0.8 0.8\nKs 0.5 0.5 0.5\nillum 3\n").materials[0].specular, 0.5, 0.5, 0.5);
}

TEST(Mtl, Illum7IsGlassWithFilter) {
  const SceneMaterial glass = with_material("Kd 1 1 1\nKs 1 1 1\nNi 2.5\nTf 0.1 0.2 0.3\nillum 7\n").materials[0];
  EXPECT_EQ(glass.kind, SurfaceKind::glass);
  EXPECT_DOUBLE_EQ(glass.refractive_index, 2.5);
  expect_colour(glass.transmittance, 0.1, 0.2, 0.3);
  expect_colour(glass.diffuse, 0, 0, 0);
}

TEST(Mtl, FilterThatIsAbsentOrZeroIsOne) {
  expect_colour(with_material("Ni 1.5\nillum 7\n").materials[0].transmittance, 1, 1, 1);
  expect_colour(with_material("Ni 1.5\nTf 0 0 0\nillum 7\n").materials[0].transmittance, 1, 1, 1);
}

TEST(Mtl, GlassWithoutIndexIsToldAndIs1Point5) {
  const Scene scene = with_material("illum 7\n");
  EXPECT_DOUBLE_EQ(scene.materials[0].refractive_index, 1.5);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("glass without Ni")));
}

TEST(Mtl, ReflectancesOfOneOrMoreAreScaled) {
  const Scene white = with_material("Kd 1 0.5 0\n");
  expect_colour(white.materials[0].diffuse, 0.99, 0.495, 0);
  EXPECT_THAT(white.warnings, Contains(HasSubstr("a.mtl:1: reflectances (Kd + Ks) of one or more")));
  expect_colour(with_material("Ks 2 1 1\nillum 3\n").materials[0].specular, 0.99, 0.495, 0.495);
  expect_colour(with_material("Kd 0.99 0.98 0.97\n").materials[0].diffuse, 0.99, 0.98, 0.97);
}

TEST(Mtl, FilterAboveOneIsCut) {
  expect_colour(with_material("Ni 1.5\nTf 3 0.5 1\nillum 7\n").materials[0].transmittance, 1, 0.5, 1);
}

TEST(Mtl, UnusedThingsAreTold) {
  const Scene scene = with_material("Kd 0.5 0.5 0.5\nd 0.5\nmap_Ks wood.png\nbanana 3\n");
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("half transparency is not rendered")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("textures other than map_Kd and map_d are not used: map_Ks")));
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("'banana' is not known")));
  EXPECT_THAT(with_material("d 1.0\nTr 0.0\nKd 0.5\n").warnings, testing::Not(Contains(HasSubstr("transparency"))));
}

TEST(Mtl, RefusalsNameFileAndLine) {
  EXPECT_THAT(refused("Kd nan 0 0\n"), StartsWith("a.mtl:2: 'nan' is not a finite number"));
  EXPECT_THAT(refused("Kd 0.5 0.5\n"), StartsWith("a.mtl:2: Kd has 2 values"));
  EXPECT_THAT(refused("\nKe -1 0 0\n"), StartsWith("a.mtl:3: Ke is -1; it must not be negative"));
  EXPECT_THAT(refused("Kd spectral file.rfl\n"), HasSubstr("a.mtl:2: Kd as a spectrum"));
  EXPECT_THAT(refused("illum 11\n"), StartsWith("a.mtl:2: illum '11'"));
  EXPECT_THAT(refused("illum\n"), StartsWith("a.mtl:2: "));
  EXPECT_THAT(refused("Ni 0\nillum 7\n"), HasSubstr("refractive index (Ni)"));
  EXPECT_THAT(refused("Ke 1 1 1\nNi 1.5\nillum 7\n"), HasSubstr("is a mirror or glass and emits"));
  EXPECT_THAT(refused("Ke 1 1 1\nKs 0.5 0.5 0.5\nillum 3\n"), HasSubstr("is a mirror or glass and emits"));
}

TEST(Mtl, AStatementThatStandsTwiceIsTold) {
  const Scene scene = with_material("Kd 0.5\nillum 1\nKd 0.25\nKd 0.75\n");
  expect_colour(scene.materials.at(0).diffuse, 0.75, 0.75, 0.75);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("a.mtl:4: of a statement that stands twice in a material the last one "
                                                 "counts: Kd, first in line 2 (and 1 more)")));
  // Each material has its own.
  const Scene two = with_material("Kd 0.5\nnewmtl other\nKd 0.25\n");
  EXPECT_THAT(two.warnings, testing::Not(Contains(HasSubstr("stands twice"))));
}

}  // namespace
}  // namespace torolux
