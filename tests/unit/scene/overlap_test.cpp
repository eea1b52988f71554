// SPDX-License-Identifier: MIT
// Proves that no two surfaces are left in one plane: doubled ones are one, lower ones are cut out, what is closed stays
// closed, and clean scenes stay as they are.
#include <map>

#include "tests/unit/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kMaterials =
    "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl other\nKd 0.2 0.2 0.2\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n"
    "newmtl lamp2\nKd 0 0 0\nKe 2 2 2\n";

Scene loaded(const std::string& obj) {
  return load_texts({{"a.obj", "mtllib a.mtl\n" + obj}, {"a.mtl", kMaterials}}, "a.obj");
}

/// A TGA image, true colour, 1 x 1.
std::string one_pixel() {
  std::string text(21, '\x7f');
  std::fill_n(text.begin(), 18, '\0');
  text[2] = 2;
  text[12] = text[14] = 1;
  text[16] = 24;
  return text;
}

/// A closed room of edge 10, fronts inwards.
const std::string kRoom =
    "usemtl wall\nv 0 0 0\nv 10 0 0\nv 10 0 10\nv 0 0 10\nv 0 10 0\nv 10 10 0\nv 10 10 10\nv 0 10 10\n"
    "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 4 1 5 8\nf 2 3 7 6\nf 3 4 8 7\n";

/// A level rectangle, its front downwards.
std::string sheet(const std::string& material, double x0, double z0, double x1, double z1, double y) {
  std::string text = "usemtl " + material + "\n";
  for (const auto& [x, z] : {std::pair{x0, z0}, {x1, z0}, {x1, z1}, {x0, z1}})
    text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
  return text + "f -4 -3 -2 -1\n";
}

double area_of(const Scene& scene, const std::string& material) {
  double sum = 0;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t)
    if (scene.materials[scene.triangles[t].material].name == material) sum += area(scene, t);
  return sum;
}

/// Edges that are not met once in each direction.
std::size_t open_edges(const Scene& scene) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const SceneTriangle& triangle : scene.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = triangle.position[i];
      const std::uint32_t b = triangle.position[(i + 1) % 3];
      edges[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  return static_cast<std::size_t>(std::ranges::count_if(edges, [](const auto& edge) { return edge.second != 0; }));
}

TEST(Overlaps, ADoubledRoomIsTheRoom) {
  const Scene once = loaded(kRoom);
  const Scene twice = loaded(kRoom + "f 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 8 5 1 4\nf 6 7 3 2\nf 7 8 4 3\n");
  // Cut along the other diagonals.
  const Scene otherwise = loaded(kRoom + "f 2 3 4 1\nf 7 6 5 8\nf 6 2 1 5\nf 5 1 4 8\nf 7 3 2 6\nf 8 4 3 7\n");
  for (const Scene* scene : {&twice, &otherwise}) {
    EXPECT_EQ(scene->positions, once.positions);
    ASSERT_EQ(scene->triangles.size(), once.triangles.size());
    for (std::size_t t = 0; t < once.triangles.size(); ++t)
      EXPECT_EQ(scene->triangles[t].position, once.triangles[t].position);
    EXPECT_THAT(scene->warnings, Contains(HasSubstr("a surface that stands twice")));
  }
}

TEST(Overlaps, ALampInTheCeilingsPlaneTakesItsPlace) {
  const Scene scene = loaded(kRoom + sheet("lamp", 2, 3, 5, 7, 10));
  EXPECT_NEAR(area_of(scene, "lamp"), 12, 1e-9);
  EXPECT_NEAR(area_of(scene, "wall"), 600 - 12, 1e-9);
  EXPECT_EQ(open_edges(scene), 0U);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("'lamp' on 'wall'")));
}

TEST(Overlaps, WhatIsClosedStaysClosedAtABorderAndInThreeLayers) {
  // The upper sheets end at the ceiling's border, so that its walls' edges are divided, too.
  const Scene scene = loaded(kRoom + sheet("other", 0, 1, 6, 9, 10) + sheet("lamp", 1.3, 0, 4.7, 7.1, 10));
  EXPECT_NEAR(area_of(scene, "lamp"), 3.4 * 7.1, 1e-9);
  EXPECT_NEAR(area_of(scene, "other"), 48 - 3.4 * 6.1, 1e-9);
  EXPECT_NEAR(area_of(scene, "wall"), 600 - 48 - 3.4, 1e-9);
  EXPECT_EQ(open_edges(scene), 0U);
}

TEST(Overlaps, TheSmallerLiesOnTopWhateverTheOrder) {
  const std::string small = sheet("other", 4, 4, 6, 6, 3);
  const std::string large = sheet("wall", 0, 0, 9, 9, 3);
  for (const std::string& text : {small + large, large + small}) {
    const Scene scene = loaded(text);
    EXPECT_NEAR(area_of(scene, "other"), 4, 1e-9);
    EXPECT_NEAR(area_of(scene, "wall"), 77, 1e-9);
  }
  // A lamp lies on top even where it is the larger one.
  const Scene lit = loaded(small + sheet("lamp", 0, 0, 9, 9, 3));
  EXPECT_NEAR(area_of(lit, "lamp"), 81, 1e-9);
  EXPECT_EQ(area_of(lit, "other"), 0);
}

TEST(Overlaps, EmittersBackToBackBothShine) {
  const Scene scene = loaded(sheet("lamp", 0, 0, 4, 4, 3) + "f -1 -2 -3 -4\n");
  EXPECT_NEAR(area_of(scene, "lamp"), 32, 1e-9);
  double low = 3;
  double high = 3;
  for (const SceneTriangle& triangle : scene.triangles) {
    low = std::min(low, scene.positions[triangle.position[0]][1]);
    high = std::max(high, scene.positions[triangle.position[0]][1]);
  }
  EXPECT_NEAR(high - low, 2 * 4e-5, 1e-9);
}

TEST(Overlaps, NeighboursAndStandingSolidsAreLeftInPeace) {
  const std::string solid =
      "usemtl other\nv 2 0 2\nv 4 0 2\nv 4 0 4\nv 2 0 4\nv 2 2 2\nv 4 2 2\nv 4 2 4\nv 2 2 4\n"
      "f -8 -7 -6 -5\nf -1 -2 -3 -4\nf -4 -3 -7 -8\nf -1 -4 -8 -5\nf -3 -2 -6 -7\nf -2 -1 -5 -6\n";
  for (const std::string& text : {kRoom + solid, sheet("wall", 0, 0, 4, 4, 3) + sheet("other", 4, 0, 8, 4, 3)}) {
    const Scene scene = loaded(text);
    EXPECT_THAT(scene.warnings, Not(Contains(HasSubstr("plane")))) << text;
    EXPECT_EQ(scene.triangles.size() % 2, 0U);
  }
  EXPECT_EQ(loaded(kRoom + solid).triangles.size(), 24U);
}

TEST(Overlaps, TexturePointsFollowTheirPlace) {
  const Scene scene =
      load_texts({{"a.obj", "mtllib a.mtl\n" + sheet("other", 4, 4, 6, 6, 3) +
                                "usemtl picture\nv 0 3 0\nv 8 3 0\nv 8 3 8\nv 0 3 8\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
                                "f -4/1 -3/2 -2/3 -1/4\n"},
                  {"a.mtl", kMaterials + "newmtl picture\nKd 1 1 1\nmap_Kd a.tga\n"},
                  {"a.tga", one_pixel()}},
                 "a.obj");
  std::size_t seen = 0;
  for (const SceneTriangle& triangle : scene.triangles) {
    if (triangle.texture_points == kNoImage) continue;
    for (std::size_t i = 0; i < 3; ++i) {
      const Vec3d& p = scene.positions[triangle.position[i]];
      const auto& uv = scene.texture_points[triangle.texture_points + i];
      EXPECT_NEAR(uv[0], p[0] / 8, 1e-9);
      EXPECT_NEAR(uv[1], p[2] / 8, 1e-9);
      ++seen;
    }
  }
  EXPECT_GT(seen, 6U);
}

}  // namespace
}  // namespace torolux
