// SPDX-License-Identifier: MIT
// Proves what MGF's materials and colours become, and that a scene is the same whether MGF or OBJ says it.
#include <fstream>
#include <iomanip>
#include <sstream>

#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/written_scenes.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

Scene scene_of(const std::string& material) {
  return load_texts({{"a.mgf", "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nm test =\n" + material + "f a b c\n"}},
                    "a.mgf");
}
SceneMaterial material(const std::string& text) {
  return scene_of(text).materials[0];
}
/// But that no camera is named, which is told of each.
std::vector<std::string> told(const std::string& text) {
  std::vector<std::string> lines = scene_of(text).warnings;
  std::erase_if(lines, [](const std::string& line) { return line.find("camera") != std::string::npos; });
  return lines;
}

void expect_grey(const Vec3d& rgb, double value) {
  for (const double channel : rgb) EXPECT_NEAR(channel, value, 1e-9);
}

TEST(MgfMaterial, DiffuseGlossyMirror) {
  const SceneMaterial paint = material("rd .6\nrs .04 .1\n");
  expect_grey(paint.diffuse, 0.6);
  expect_grey(paint.specular, 0.04);
  EXPECT_NEAR(paint.exponent, 50, 1e-9);
  EXPECT_EQ(paint.kind, SurfaceKind::diffuse);
  const SceneMaterial mirror = material("rs .9 0\n");
  EXPECT_EQ(mirror.kind, SurfaceKind::mirror);
  expect_grey(mirror.specular, 0.9);
  EXPECT_DOUBLE_EQ(material("rd .3\nrs .1 0\n").exponent, 10'000);
  EXPECT_DOUBLE_EQ(material("rs .5 1e-9\n").exponent, 10'000);
  EXPECT_THAT(told("rd .6\nrs .04 .1\n"), IsEmpty());
}

// The lobe of facets: at the angle where theirs has fallen to 1/e, so has ours, at twice that angle.
TEST(MgfMaterial, LobesAreAsWideAsTheFacetsMakeThem) {
  for (const double roughness : {0.05, 0.1, 0.2}) {
    const double exponent = material("rs .5 " + std::to_string(roughness) + "\n").exponent;
    EXPECT_NEAR(std::pow(std::cos(2 * std::atan(roughness)), exponent), std::exp(-1), 0.015) << roughness;
  }
}

// 179 lumens to the watt, and pi to the half space.
TEST(MgfMaterial, LightsShineFromTheirFronts) {
  const SceneMaterial lamp = material("sides 1\ned 1000\nrd .2\n");
  expect_grey(lamp.emission, 1000 / (179 * 3.14159265358979));
  expect_grey(lamp.diffuse, 0.2);
  EXPECT_THAT(told("sides 1\ned 1000\n"), IsEmpty());
  EXPECT_THAT(told("ed 1000\n"), Contains(HasSubstr("a.mgf:7: a surface of two sides emits from its front alone")));
  const Vec3d warm = material("sides 1\nc\ncct 2856\ned 1000\n").emission;
  EXPECT_NEAR(luminance(warm), 1000 / (179 * 3.14159265358979), 1e-9);
  EXPECT_GT(warm[0], 3 * warm[2]);
}

/// What a pane lets pass and reflects from straight ahead (docs/materials.md, Panes).
std::pair<double, double> shares(const SceneMaterial& pane, std::size_t channel) {
  const double face = std::pow((pane.refractive_index - 1) / (pane.refractive_index + 1), 2);
  const double t = pane.transmittance[channel];
  const double through = t * (1 - face) * (1 - face) / (1 - t * t * face * face);
  return {through, face + t * face * through};
}

TEST(MgfMaterial, PanesLetThroughWhatTheFileSays) {
  const SceneMaterial pane = material("ts .94 0\nrs .04 0\n");
  EXPECT_EQ(pane.kind, SurfaceKind::glass);
  EXPECT_TRUE(pane.thin);
  EXPECT_NEAR(shares(pane, 0).first, 0.94, 1e-9);
  EXPECT_NEAR(shares(pane, 0).second, 0.04, 1e-9);
  const SceneMaterial clear = material("ts 1 0\n");
  EXPECT_DOUBLE_EQ(clear.refractive_index, 1);
  expect_grey(clear.transmittance, 1);
  // The specification's green glass (ts): two sides and an index.
  const SceneMaterial green = material("sides 2\nir 1.52 0\nc\nrs .0725 0\nc\ncxy .23 .38\nts .5815 0\n");
  EXPECT_TRUE(green.thin);
  EXPECT_DOUBLE_EQ(green.refractive_index, 1.52);
  EXPECT_NEAR(luminance({shares(green, 0).first, shares(green, 1).first, shares(green, 2).first}), 0.5815, 1e-9);
  EXPECT_GT(green.transmittance[1], green.transmittance[0]);
}

// The specification's crystal ball (sides): one side and an index.
TEST(MgfMaterial, SolidGlass) {
  const std::string crystal = "ir 1.65 0\nsides 1\nc\nrs .0602 0\nc\nts .6425 0\n";
  const SceneMaterial glass = material(crystal);
  EXPECT_EQ(glass.kind, SurfaceKind::glass);
  EXPECT_FALSE(glass.thin);
  EXPECT_DOUBLE_EQ(glass.refractive_index, 1.65);
  // Two crossings of its surface absorb as one way through a pane does.
  SceneMaterial pane = glass;
  for (double& t : pane.transmittance) t *= t;
  EXPECT_NEAR(shares(pane, 1).first, 0.6425, 1e-9);
  EXPECT_THAT(told(crystal), Contains(HasSubstr("as if it were 5 mm thick")));
}

TEST(MgfMaterial, WhatHasNoCounterpartIsTold) {
  EXPECT_THAT(told("rd .5\ntd .2\n"), Contains(HasSubstr("diffuse transmittance (td) is not rendered")));
  EXPECT_THAT(told("rd .5\nts .2 0\n"), Contains(HasSubstr("specular transmittance (ts) beside more diffuse")));
  EXPECT_EQ(material("rd .5\nts .2 0\n").kind, SurfaceKind::diffuse);
  EXPECT_THAT(told("rs .05 0\nts .4 .05\n"), Contains(HasSubstr("roughness of glass (ts) is not rendered")));
  EXPECT_THAT(told("rd .2\nts .4 0\n"), Contains(HasSubstr("the diffuse part of glass (rd) is not rendered")));
  EXPECT_THAT(told("ir 9 0\nts .4 0\n"), Contains(HasSubstr("beyond 0.2 to 5")));
  EXPECT_THAT(told("ir 1.5 0\nts .4 0\n"), Contains(HasSubstr("reflects as its index of refraction")));
  EXPECT_THAT(told("c\ncxy .07 .83\nrd .1\n"), Contains(HasSubstr("replaced by the nearest")));
}

// One context, several colours: what counts is the colour that is current when a value is set.
TEST(MgfMaterial, ValuesTakeTheColourOfTheirTime) {
  const SceneMaterial plastic = material("c blue =\ncxy .2 .25\nc\nrd .2\nc blue\nrs .1 .1\nc red = blue\ncxy .5 .3\n");
  expect_grey(plastic.diffuse, 0.2);
  EXPECT_GT(plastic.specular[2], 2 * plastic.specular[0]);
}

// The specification's monitor (cmix): these primaries in these amounts are white.
TEST(MgfMaterial, MixturesOfColours) {
  const Vec3d white = material(
                          "c R =\ncxy .64 .33\nc G =\ncxy .29 .6\nc B =\ncxy .15 .06\nc white =\n"
                          "cmix 0.265 R 0.670 G 0.065 B\nrd .5\n")
                          .diffuse;
  for (const double channel : white) EXPECT_NEAR(channel, 0.5, 0.01);
  // Spectra and chromaticities mix by their brightness: half equal energy, half lamplight.
  const Vec3d mixed = material("c day =\ncspec 380 780 1 1\nc lamp =\ncct 2856\nc\ncmix 1 day 1 lamp\nrd .5\n").diffuse;
  const LinearColour lamp = linear_colour({0.4476, 0.4074}, 0.25);
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(mixed[i], 0.25 + lamp.rgb[i], 1e-3);
}

TEST(MgfMaterial, CornellBoxIsTheSameSceneAsFromObj) {
  const std::filesystem::path box = std::filesystem::path(TOROLUX_SOURCE_DIR) / "scenes" / "cornell_box";
  const Scene obj = load_scene(box, {});
  const testing_support::TemporaryFolder folder;
  std::ofstream(folder.path() / "box.mgf") << as_mgf(obj);
  const Scene mgf = load_scene(folder.path() / "box.mgf", {});
  EXPECT_EQ(mgf.positions, obj.positions);
  ASSERT_EQ(mgf.triangles.size(), obj.triangles.size());
  for (std::size_t i = 0; i < obj.triangles.size(); ++i) {
    EXPECT_EQ(mgf.triangles[i].position, obj.triangles[i].position);
    EXPECT_EQ(mgf.triangles[i].material, obj.triangles[i].material);
  }
  ASSERT_EQ(mgf.materials.size(), obj.materials.size());
  for (std::size_t i = 0; i < obj.materials.size(); ++i)
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_NEAR(mgf.materials[i].diffuse[c], obj.materials[i].diffuse[c], 1e-6) << obj.materials[i].name;
      EXPECT_NEAR(mgf.materials[i].emission[c], obj.materials[i].emission[c], 1e-5) << obj.materials[i].name;
    }
}

// A repeated statement's colour is worked out once, and is that statement's.
TEST(MgfMaterial, ColoursInArraysStayTheirStatements) {
  const Scene scene =
      load_texts({{"a.mgf",
                   "v a =\np 0 0 0\nv b =\np 1 0 0\nv c =\np 1 1 0\nv d =\np 0 1 0\nm one =\nxf -a 3 -t 0 0 1\n"
                   "c\ncct 3000\nrd .3\nf a b c\nc\ncct 6000\nrd .3\nf a c b\n"
                   "c\ncspec 400 700 3 2 1\nrd .3\nf a c d\nxf\n"}},
                 "a.mgf");
  ASSERT_EQ(scene.materials.size(), 3U);
  EXPECT_GT(scene.materials[0].diffuse[0], scene.materials[1].diffuse[0]);
  EXPECT_GT(scene.materials[2].diffuse[2], scene.materials[1].diffuse[2]);
}

}  // namespace
}  // namespace torolux
