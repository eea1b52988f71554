// SPDX-License-Identifier: MIT
// Proves that no two surfaces are left in one plane: doubled ones are one, lower ones are cut out, what is closed stays
// closed, and clean scenes stay as they are.
#include <cmath>
#include <cstdio>
#include <map>
#include <sstream>

#include "host_tools/scene/imported_mesh.hpp"
#include "host_tools/scene/ray_cast.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

const std::string kMaterials =
    "newmtl wall\nKd 0.5 0.5 0.5\nnewmtl other\nKd 0.2 0.2 0.2\nnewmtl lamp\nKd 0 0 0\nKe 1 1 1\n"
    "newmtl lamp2\nKd 0 0 0\nKe 2 2 2\nnewmtl plaster\nKd 0.5 0.5 0.5\nnewmtl pane\nillum 7\nNi 1.5\nTf 1 1 1\n";

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

/// The same turned about an axis that is none of the scene's, with six digits behind the point as exporters write.
std::string tilted(const std::string& obj) {
  constexpr double c = 0.8;
  constexpr double s = 0.6;
  std::istringstream in(obj);
  std::string text;
  for (std::string line; std::getline(in, line);) {
    Vec3d v{};
    if (std::sscanf(line.c_str(), "v %lf %lf %lf", &v[0], &v[1], &v[2]) == 3) {
      const Vec3d once{c * v[0] - s * v[1], s * v[0] + c * v[1], v[2]};
      std::array<char, 96> turned{};
      std::snprintf(turned.data(), turned.size(), "v %.6f %.6f %.6f", once[0], c * once[1] - s * once[2],
                    s * once[1] + c * once[2]);
      line = turned.data();
    }
    text += line + "\n";
  }
  return text;
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

/// All that is seen from a point along a direction: the material of the nearest surface.
std::string seen(const Scene& scene, const Vec3d& from, const Vec3d& direction) {
  const auto hit = cast_ray(scene, from, direction);
  return hit ? scene.materials[scene.triangles[hit->triangle].material].name : "";
}

TEST(Overlaps, ASheetWithTwoColoursShowsEachOnItsSide) {
  // Fronts down and up; the second is cut along the other diagonal.
  const std::string down = sheet("wall", 0, 0, 4, 4, 3);
  const std::string up = "usemtl other\nv 0 3 0\nv 0 3 4\nv 4 3 4\nv 4 3 0\nf -3 -2 -1 -4\n";
  for (const std::string& text : {down + up, up + down}) {
    const Scene scene = loaded(text);
    EXPECT_NEAR(area_of(scene, "wall"), 16, 1e-9);
    EXPECT_NEAR(area_of(scene, "other"), 16, 1e-9);
    for (const auto& [x, z] : {std::pair{1.1, 2.3}, {3.9, 0.2}, {2.0, 3.7}}) {
      EXPECT_EQ(seen(scene, {x, 0, z}, {0, 1, 0}), "wall");
      EXPECT_EQ(seen(scene, {x, 6, z}, {0, -1, 0}), "other");
    }
    EXPECT_THAT(scene.warnings, Contains(HasSubstr("shows each on its side")));
  }
  // The same look under two names is one surface; so is one that does not have the same outline.
  const Scene alike = loaded(down + "usemtl plaster\nv 0 3 0\nv 0 3 4\nv 4 3 4\nv 4 3 0\nf -3 -2 -1 -4\n");
  EXPECT_NEAR(area_of(alike, "wall") + area_of(alike, "plaster"), 16, 1e-9);
  const Scene rug = loaded(sheet("wall", 0, 0, 9, 9, 3) + up);
  EXPECT_EQ(seen(rug, {1.1, 0, 2.3}, {0, 1, 0}), "other");
  EXPECT_EQ(seen(rug, {1.1, 6, 2.3}, {0, -1, 0}), "other");
}

TEST(Overlaps, ARoomWithOtherColoursOutsideStaysClosed) {
  const Scene scene =
      loaded(kRoom + "usemtl other\nf 1 2 3 4\nf 8 7 6 5\nf 5 6 2 1\nf 8 5 1 4\nf 6 7 3 2\nf 7 8 4 3\n");
  EXPECT_NEAR(area_of(scene, "wall"), 600, 1e-6);
  EXPECT_NEAR(area_of(scene, "other"), 600, 1e-6);
  Scene inside = scene;
  std::erase_if(inside.triangles, [&](const SceneTriangle& t) { return scene.materials[t.material].name != "wall"; });
  EXPECT_EQ(open_edges(inside), 0U);
  EXPECT_EQ(seen(scene, {5, 5, 5}, {0.3, 1, 0.2}), "wall");
  EXPECT_EQ(seen(scene, {5, 25, 5}, {0, -1, 0.1}), "other");
}

TEST(Overlaps, GlassBackToBackIsAThinPane) {
  const Scene scene = loaded(sheet("pane", 0, 0, 4, 4, 3) + "f -1 -2 -3 -4\n");
  EXPECT_NEAR(area_of(scene, "pane"), 32, 1e-9);
  double low = 3;
  double high = 3;
  for (const Vec3d& p : scene.positions) {
    low = std::min(low, p[1]);
    high = std::max(high, p[1]);
  }
  EXPECT_NEAR(high - low, 2 * 4e-5, 1e-9);
  EXPECT_THAT(scene.warnings, Contains(HasSubstr("thin pane")));
}

// By six digits behind the point, areas are right to 1e-6 of each length.
TEST(Overlaps, NoPlaneNeedsToBeParallelToAnAxis) {
  const Scene doubled = loaded(tilted(kRoom + "f 2 3 4 1\nf 7 6 5 8\nf 6 2 1 5\nf 5 1 4 8\nf 7 3 2 6\nf 8 4 3 7\n"));
  EXPECT_NEAR(area_of(doubled, "wall"), 600, 1e-3);
  EXPECT_EQ(open_edges(doubled), 0U);
  const Scene layers = loaded(tilted(kRoom + sheet("other", 0, 1, 6, 9, 10) + sheet("lamp", 1.3, 0, 4.7, 7.1, 10)));
  EXPECT_NEAR(area_of(layers, "lamp"), 3.4 * 7.1, 1e-3);
  EXPECT_NEAR(area_of(layers, "other"), 48 - 3.4 * 6.1, 1e-3);
  EXPECT_NEAR(area_of(layers, "wall"), 600 - 48 - 3.4, 1e-3);
  EXPECT_EQ(open_edges(layers), 0U);
  const Scene colours = loaded(tilted(sheet("wall", 0, 0, 4, 4, 3) + "usemtl other\nf -1 -2 -3 -4\n"));
  EXPECT_NEAR(area_of(colours, "wall") + area_of(colours, "other"), 32, 1e-3);
  EXPECT_NE(colours.triangles[0].position, colours.triangles[2].position);
  const Scene standing = loaded(tilted(sheet("wall", 0, 0, 4, 4, 3) + sheet("other", 4, 0, 8, 4, 3)));
  EXPECT_EQ(standing.triangles.size(), 4U);
  EXPECT_THAT(standing.warnings, Not(Contains(HasSubstr("plane"))));
}

TEST(Overlaps, WhatIsTooMuchIsTold) {
  // Each of 2,500 tiles adds some two pieces to the triangle below.
  std::string tiles = "usemtl wall\nv 0 3 0\nv 101 3 0\nv 0 3 101\nf 1 2 3\n";
  for (int i = 0; i < 50; ++i)
    for (int k = 0; k < 50; ++k) tiles += sheet("other", i + 0.2, k + 0.3, i + 0.7, k + 0.6, 3);
  EXPECT_THAT(loaded(tiles).warnings,
              Contains(HasSubstr("stays whole below it: they overlap in one plane; divide it, or move it down: "
                                 "'other' on 'wall'")));
  // 10,100 strips, each beside all others along the longest axis: 51 million pairs.
  std::string strips;
  for (int i = 0; i < 10'100; ++i) strips += sheet("wall", 0, i, 20'000, i + 0.5, 3);
  EXPECT_THAT(loaded(strips).warnings, Contains(HasSubstr("not all were looked at: take out what lies below")));
}

// Each strip's edges have the corners of all others on them: as many triangles as strips times strips, if all were cut.
TEST(Overlaps, ThousandsThatAreShiftedAlongOneLineEndSoon) {
  std::string strips;
  for (int i = 0; i < 2000; ++i) strips += sheet(i % 2 == 0 ? "wall" : "other", i, 0, i + 5000, 1, 3);
  const Scene scene = loaded(strips);
  EXPECT_THAT(scene.warnings, Contains(AllOf(HasSubstr("a.obj: so many surfaces lie in one plane that not all were "
                                                       "looked at: take out what lies below others, or it may show"),
                                             Not(HasSubstr("more)")))));
  EXPECT_LT(scene.triangles.size(), kMostTriangles);
}

// 7,200 corners of tiles beside a floor lie on its edge, which is not divided for so many; for half of them it is.
TEST(Overlaps, AnEdgeWithTooManyCornersStaysWhole) {
  const auto floor = [](int tiles) {
    std::string text = sheet("wall", 0, 0, 8000, 10, 3) + sheet("other", 1, 1, 2, 2, 3);
    for (int i = 0; i < tiles; ++i)
      text +=
          sheet("wall", 2 * i + 0.5, -1, 2 * i + 1.5, 0, 3) + sheet("other", 2 * i + 0.6, -0.9, 2 * i + 1.4, -0.1, 3);
    return loaded(text);
  };
  const auto of_floor = [](const Scene& scene) {
    return std::ranges::count_if(scene.triangles, [&scene](const SceneTriangle& triangle) {
      return std::ranges::all_of(triangle.position, [&scene](std::uint32_t p) { return scene.positions[p][2] >= 0; });
    });
  };
  const Scene divided = floor(1800);
  EXPECT_THAT(divided.warnings, Not(Contains(HasSubstr("not all were looked at"))));
  const Scene whole = floor(3600);
  EXPECT_THAT(whole.warnings, Contains(HasSubstr("not all were looked at")));
  EXPECT_GT(of_floor(divided), 2 * 1800);
  EXPECT_LT(of_floor(whole), 100);
}

}  // namespace
}  // namespace torolux
