// SPDX-License-Identifier: MIT
// Proves that a scene.toml without any mesh makes a room: shapes, walls, lamps; and that mistakes are refused.
#include <numbers>

#include "host_tools/colour/colour.hpp"
#include "host_tools/scene/components.hpp"
#include "host_tools/scene/inspect.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::IsEmpty;
using testing::StartsWith;

Scene scene_of(const std::string& toml) {
  return load_texts({{"s.toml", toml}}, "s.toml");
}
std::string refused(const std::string& toml) {
  return refusal({{"s.toml", toml}}, "s.toml");
}

Vec3d front(const Scene& scene, std::size_t t) {
  const auto& p = scene.triangles[t].position;
  const Vec3d& a = scene.positions[p[0]];
  return vec::unit(vec::cross(vec::subtract(scene.positions[p[1]], a), vec::subtract(scene.positions[p[2]], a)));
}

vec::Box bounds(const Scene& scene) {
  vec::Box box;
  for (const Vec3d& p : scene.positions) box.include(p);
  return box;
}

/// One closed solid with this volume, fronts outwards.
void expect_solid(const std::string& toml, double volume, double tolerance) {
  const std::vector<Component> found = components(scene_of(toml));
  ASSERT_EQ(found.size(), 1U) << toml;
  EXPECT_TRUE(found[0].closed) << toml;
  EXPECT_NEAR(found[0].volume, volume, tolerance) << toml;
}

TEST(SceneShapes, SolidsAreClosedAndLookOutwards) {
  const double pi = std::numbers::pi;
  expect_solid("[[sphere]]\ncentre = [1, 2, 3]\nradius = 2\n", 32 * pi / 3, 0.5);
  expect_solid("[[box]]\ncorner = [1, 2, 3]\nsize = [1, 2, 4]\n", 8, 1e-9);
  expect_solid("[[box]]\ncentre = [1, 2, 3]\nsize = [1, 2, 4]\nrotate = [10, 20, 30]\n", 8, 1e-9);
  expect_solid("[[cylinder]]\nfrom = [0.1, 0, 0.3]\nto = [1, 2, 1]\nradius = 0.5\n", pi / 4 * std::sqrt(5.3), 0.02);
  expect_solid("[[cylinder]]\nfrom = [0, 0, 0]\nto = [0, 3, 0]\nradius = 1\ntop_radius = 0\n", pi, 0.02);
  expect_solid("[[cylinder]]\nfrom = [0, 0, 0]\nto = [0, 3, 0]\nradius = 1\ntop_radius = 0.5\n", pi * 1.75, 0.03);
  expect_solid("[[torus]]\ncentre = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 2\ntube = 0.5\n", 4 * pi * pi * 0.25, 0.1);
  expect_solid("[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\nflip = true\n", -4 * pi / 3, 0.1);
}

TEST(SceneShapes, FlatOnesLookWhereTheyAreTold) {
  EXPECT_EQ(front(scene_of("[[quad]]\ncorner = [0, 0, 0]\nedges = [[1, 0, 0], [0, 1, 0]]\n"), 0), (Vec3d{0, 0, 1}));
  EXPECT_EQ(front(scene_of("[[quad]]\ncentre = [0, 0, 0]\nsize = [1, 1]\nfacing = [0, -2, 0]\n"), 0),
            (Vec3d{0, -1, 0}));
  const Scene disc = scene_of("[[disc]]\ncentre = [0, 0, 0]\nfacing = [0, 3, 0]\nradius = 2\nhole = 1\n");
  double sum = 0;
  for (std::size_t t = 0; t < disc.triangles.size(); ++t) {
    sum += area(disc, t);
    EXPECT_NEAR(front(disc, t)[1], 1, 1e-9);
  }
  EXPECT_NEAR(sum, 3 * std::numbers::pi, 0.05);
}

TEST(SceneShapes, MaterialsAndFineness) {
  const Scene scene = scene_of(
      "[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\nmaterial = 'ball'\n"
      "[material.ball]\nglass = 1.5\ntransmittance = 0.9\n");
  EXPECT_EQ(scene.materials[0].kind, SurfaceKind::glass);
  EXPECT_FALSE(scene.materials[0].thin);
  EXPECT_EQ(scene.triangles.size(), 20U * 26 * 26);
  EXPECT_NE(scene.triangles[0].normal[0], kNoNormal);
  const Scene coarse = scene_of("[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\nedges = 12\n");
  EXPECT_EQ(coarse.triangles.size(), 20U * 3 * 3);
  EXPECT_EQ(coarse.materials[0].name, "(none)");
  EXPECT_DOUBLE_EQ(coarse.materials[0].diffuse[0], 0.7);
}

TEST(SceneShapes, ThinGlassIsAPane) {
  const std::string quad =
      "[[quad]]\ncorner = [0, 0, 0]\nedges = [[1, 0, 0], [0, 1, 0]]\nmaterial = 'w'\n[material.w]\n";
  EXPECT_TRUE(scene_of(quad + "glass = 1.5\nthin = true\n").materials[0].thin);
  EXPECT_FALSE(scene_of(quad + "glass = 1.5\nthin = false\n").materials[0].thin);
  EXPECT_THAT(refused(quad + "mirror = 0.5\nthin = true\n"),
              StartsWith("s.toml:5: material 'w' is thin, which only glass"));
}

TEST(SceneShapes, RoomLooksInwards) {
  const Scene scene = scene_of(
      "[room]\nsize = [4, 3, 5]\ncorner = [-2, 0, 0]\nmaterial = 'white'\nceiling = 'grey'\n"
      "[material.white]\ndiffuse = 0.8\n[material.grey]\ndiffuse = 0.5\n");
  const std::vector<Component> found = components(scene);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(found[0].closed);
  EXPECT_NEAR(found[0].volume, -60, 1e-9);
  EXPECT_EQ(bounds(scene).low, (Vec3d{-2, 0, 0}));
  EXPECT_EQ(bounds(scene).high, (Vec3d{2, 3, 5}));
  for (std::size_t t = 0; t < scene.triangles.size(); ++t)
    EXPECT_EQ(scene.materials[scene.triangles[t].material].name == "grey", front(scene, t)[1] == -1);
  // Without a camera of its own one stands inside.
  EXPECT_LT(scene.camera->eye[2], 5);
  EXPECT_GT(scene.camera->eye[2], 4);
}

TEST(SceneShapes, OpenWallsAreNotThere) {
  const Scene scene = scene_of("[room]\nsize = [4, 3, 5]\nopen = ['front', 'left']\n");
  EXPECT_EQ(scene.triangles.size(), 8U);
  for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
    EXPECT_NE(front(scene, t), (Vec3d{0, 0, -1}));
    EXPECT_NE(front(scene, t), (Vec3d{1, 0, 0}));
  }
  EXPECT_GT(scene.camera->eye[2], 5);
}

// However a lamp hangs, it looks into the room, lies within it, and sends out the lumens that were asked for.
TEST(SceneShapes, LampsHangWhereTheyAreTold) {
  const std::vector<std::pair<std::string, Vec3d>> walls{
      {"on the left wall", {1, 0, 0}},   {"on the right wall", {-1, 0, 0}}, {"on the floor", {0, 1, 0}},
      {"under the ceiling", {0, -1, 0}}, {"on the back wall", {0, 0, 1}},   {"on the front wall", {0, 0, -1}},
  };
  for (const auto& [at, facing] : walls)
    for (const std::string shape : {"size = [1, 0.5]\n", "radius = 0.4\n"}) {
      const Scene scene = scene_of("[room]\nsize = [4, 3, 5]\n[[lamp]]\nat = '" + at + "'\nlumen = 1500\n" + shape);
      double lumens = 0;
      vec::Box box;
      for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        const SceneMaterial& material = scene.materials[scene.triangles[t].material];
        if (!emits(material)) continue;
        EXPECT_GT(vec::dot(front(scene, t), facing), 0.999) << at;
        lumens += kLumenPerWatt * std::numbers::pi * area(scene, t) * luminance(material.emission);
        for (const std::uint32_t p : scene.triangles[t].position) box.include(scene.positions[p]);
      }
      EXPECT_NEAR(lumens, 1500, 1e-6) << at;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_GT(box.low[axis], 0) << at;
        EXPECT_LT(box.high[axis], (Vec3d{4, 3, 5})[axis]) << at;
      }
      EXPECT_THAT(inspect(scene), IsEmpty()) << at;
    }
}

TEST(SceneShapes, SizesOfHungLampsRunAlongTheirWalls) {
  const Scene scene = scene_of(
      "[room]\nsize = [4, 3, 5]\n[[lamp]]\nat = 'under the ceiling'\nsize = [3, 1]\n"
      "offset = [0.25, -1]\nradiance = [3, 2, 1]\n");
  vec::Box box;
  for (const SceneTriangle& t : scene.triangles)
    if (emits(scene.materials[t.material]))
      for (const std::uint32_t p : t.position) box.include(scene.positions[p]);
  EXPECT_NEAR(box.low[0], 0.75, 1e-12);
  EXPECT_NEAR(box.high[0], 3.75, 1e-12);
  EXPECT_NEAR(box.low[2], 1, 1e-12);
  EXPECT_NEAR(box.high[2], 2, 1e-12);
  EXPECT_EQ(scene.materials.back().emission, (Vec3d{3, 2, 1}));
}

TEST(SceneShapes, BulbsAndWarmLight) {
  const Scene scene = scene_of(
      "[room]\nsize = [4, 3, 5]\n[[lamp]]\ncentre = [2, 2, 2]\nradius = 0.1\nlumen = 806\n"
      "kelvin = 2700\n");
  const SceneMaterial& bulb = scene.materials.back();
  double lumens = 0;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t)
    if (emits(scene.materials[scene.triangles[t].material]))
      lumens += kLumenPerWatt * std::numbers::pi * area(scene, t) * luminance(bulb.emission);
  EXPECT_NEAR(lumens, 806, 1e-6);
  EXPECT_GT(bulb.emission[0], 3 * bulb.emission[2]);
  EXPECT_EQ(bulb.name, "lamp 1");
}

// In a scene of meshes, too: then the box around all is the room.
TEST(SceneShapes, LampsHangInMeshes) {
  const Texts texts{
      {"s.toml", "[[mesh]]\nfile = 'a.obj'\n[[lamp]]\nat = 'on the back wall'\nradius = 0.1\nradiance = 1\n"},
      {"a.obj", kTriangle + "v 0 0 4\nf 1 2 5\n"}};
  EXPECT_THAT(refusal(texts, "s.toml"), testing::Eq("(accepted)"));
  EXPECT_THAT(refused("[[lamp]]\nat = 'on the floor'\nradius = 1\nlumen = 1\n"),
              StartsWith("s.toml:1: [[lamp]] with 'at' needs a [room]"));
}

TEST(SceneShapes, MistakesAreRefusedWithTheirLine) {
  const std::string room = "[room]\nsize = [4, 3, 5]\n";
  const std::vector<std::pair<std::string, std::string>> mistakes{
      {"[[sphere]]\ncentre = [0, 0, 0]\nradus = 1\n",
       "s.toml:1: [[sphere]] lacks 'radius'; did you mean it by 'radus'?"},
      {"[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\ncolor = 1\n", "s.toml:4: [[sphere]] has no key 'color'"},
      {"[[sphere]]\ncentre = [0, 0, 0]\nradius = -1\n", "s.toml:3: [[sphere]] 'radius' is -1; allowed are"},
      {"[[sphere]]\ncentre = [0, 0, 0]\nradius = 1\nmaterial = 'stel'\n[material.steel]\nmirror = 1\n",
       "s.toml:1: [[sphere]] is made of material 'stel', but there is no [material.stel]; did you mean 'steel'?"},
      {"[[box]]\nsize = 1\n", "s.toml:1: [[box]] needs either 'corner'"},
      {"[[box]]\nsize = 0\ncorner = [0, 0, 0]\n", "s.toml:2: [[box]] 'size' is 0; allowed are"},
      {"[[quad]]\ncorner = [0, 0, 0]\n", "s.toml:1: [[quad]] needs either 'corner' and 'edges'"},
      {"[[disc]]\ncentre = [0, 0, 0]\nradius = 1\nhole = 1\nfacing = [0, 0, 1]\n", "s.toml:4: [[disc]] 'hole'"},
      {"[[disc]]\ncentre = [0, 0, 0]\nradius = 1\nfacing = [0, 0, 0]\n", "s.toml:4: [[disc]] 'facing' is zero"},
      {"[[cylinder]]\nfrom = [0, 0, 0]\nto = [0, 0, 0]\nradius = 1\n",
       "s.toml:3: [[cylinder]] 'from' and 'to' are one"},
      {"[[torus]]\ncentre = [0, 0, 0]\naxis = [0, 1, 0]\nradius = 1\ntube = 1\n", "s.toml:5: [[torus]] 'tube'"},
      {"[room]\nsize = [4, 3, 5]\nopen = ['door']\n",
       "s.toml:3: [room] 'open': \"door\" is no wall; did you mean 'floor'? There are: left, right"},
      {"[room]\nsize = [4, 3, 5]\nopen = 'front'\n", "s.toml:3: [room] 'open' must be a list of walls"},
      {room + "[[lamp]]\nat = 'under the celing'\nradius = 1\nlumen = 1\n",
       "s.toml:4: [[lamp]] 'at': \"under the celing\" is no wall"},
      {room + "[[lamp]]\nat = 'under the ceiling'\nlumen = 1\n", "s.toml:3: [[lamp]] with 'at' needs either 'size' or"},
      {room + "[[lamp]]\nat = 'under the ceiling'\nsize = [5, 1]\nlumen = 1\n",
       "s.toml:3: [[lamp]] does not lie within its wall, which is 4.000000 by 5.000000"},
      {room + "[[lamp]]\ncentre = [1, 1, 1]\nradius = 0.1\n", "s.toml:3: [[lamp]] needs either 'lumen' or 'radiance'"},
      {room + "[[lamp]]\nlumen = 1\nradius = 0.1\n", "s.toml:3: [[lamp]] with a 'radius' needs a 'centre'"},
      {room + "[[lamp]]\nlumen = 1\nkelvin = 3000\ncolour = [1, 1, 1]\n",
       "s.toml:3: [[lamp]] has both 'colour' and 'kelvin'"},
  };
  for (const auto& [text, message] : mistakes) EXPECT_THAT(refused(text), StartsWith(message)) << text;
}

}  // namespace
}  // namespace torolux
