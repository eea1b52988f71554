// SPDX-License-Identifier: MIT
// Proves that every scene of the repository loads without complaint, and each foreign one loads or is refused with its
// reason; that --studio makes any mesh renderable.
#include <filesystem>
#include <fstream>
#include <set>

#include "host_tools/scene/dark_view.hpp"
#include "host_tools/scene/inspect.hpp"
#include "host_tools/scene/vec.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

const std::filesystem::path kRoot = TOROLUX_SOURCE_DIR;
const std::filesystem::path kForeign = kRoot / ".." / "shared" / "scenes";

bool inside(const vec::Box& box, const Vec3d& p) {
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (!(p[axis] > box.low[axis] && p[axis] < box.high[axis])) return false;
  return true;
}

vec::Box bounds(const Scene& scene) {
  vec::Box box;
  for (const Vec3d& p : scene.positions) box.include(p);
  return box;
}

double emitted_power(const Scene& scene) {
  double sum = 0;
  for (std::size_t t = 0; t < scene.triangles.size(); ++t)
    sum += area(scene, t) * scene.materials[scene.triangles[t].material].emission[0];
  return sum;
}

TEST(RepositoryScenes, LoadWithoutWarnings) {
  for (const char* folder : {"scenes", "tests/data/scenes"}) {
    for (const auto& entry : std::filesystem::directory_iterator(kRoot / folder)) {
      if (!std::filesystem::exists(entry.path() / "scene.toml")) continue;
      SCOPED_TRACE(entry.path().string());
      const Scene scene = load_scene(entry.path(), {});
      EXPECT_THAT(scene.warnings, IsEmpty());
      EXPECT_THAT(inspect(scene), IsEmpty());
      // Three scenes ask for leaks, or for flux alone: their cameras see nothing that is lit.
      const std::set<std::string> black{"thin_wall", "crossed_wall", "facing_squares"};
      EXPECT_EQ(inspect_view(scene, scene.camera.value(), 1, false).size(),
                black.count(entry.path().filename().string()));
      EXPECT_NO_THROW(check_renderable(scene));
      EXPECT_EQ(scene.name, entry.path().filename());
    }
  }
}

// What the scaling of the machine is measured on: 1,000 boxes that touch nothing, three of four in one corner.
TEST(MadeScenes, ClutteredRoomIsAsDocumented) {
  const Scene scene = load_scene(std::filesystem::path(TOROLUX_MADE_SCENES) / "cluttered_room", {});
  EXPECT_THAT(scene.warnings, IsEmpty());
  EXPECT_THAT(inspect(scene), IsEmpty());
  EXPECT_NO_THROW(check_renderable(scene));
  ASSERT_EQ(scene.triangles.size(), 12U + 1000 * 12 + 2);
  const vec::Box all = bounds(scene);
  EXPECT_EQ(all.low, (Vec3d{0, 0, 0}));
  EXPECT_EQ(all.high, (Vec3d{6, 3, 6}));
  std::uint32_t in_the_corner = 0;
  for (std::size_t t = 12; t < 12 + 12000; ++t) {
    bool near = true;
    for (const std::uint32_t corner : scene.triangles[t].position) {
      for (const double x : scene.positions[corner]) near = near && x > 0 && x < 2;
    }
    if (near) ++in_the_corner;
  }
  EXPECT_GT(in_the_corner, 9000U) << "triangles";
  EXPECT_NEAR(emitted_power(scene), 12, 1e-9);  // [W/sr] of 1 x 1
}

TEST(RepositoryScenes, CornellBoxIsThePublishedOne) {
  const Scene scene = load_scene(kRoot / "scenes/cornell_box", {});
  EXPECT_EQ(scene.triangles.size(), 32U);
  EXPECT_NEAR(emitted_power(scene), 130.0 * 105.0 * 17.0, 1e-6);
  const Camera camera = scene.camera.value_or(Camera{});
  // 25 mm of film behind 35 mm: 2 atan(12.5 / 35).
  EXPECT_NEAR(camera.field_of_view_degrees, 2 * std::atan(12.5 / 35) * 180 / 3.14159265358979, 1e-4);
}

TEST(RepositoryScenes, CornellQuadsAreThoseOfTheScene) {
  std::ifstream file(kRoot / "tests/data/cornell_quads.csv");
  const Scene scene = load_scene(kRoot / "scenes/cornell_box", {});
  std::string line;
  std::getline(file, line);
  std::size_t quads = 0;
  while (std::getline(file, line)) {
    std::istringstream words(line.substr(line.find(',') + 1));
    for (int corner = 0; corner < 4; ++corner) {
      Vec3d p{};
      char comma = 0;
      words >> p[0] >> comma >> p[1] >> comma >> p[2] >> comma;
      EXPECT_THAT(scene.positions, Contains(p)) << line;
    }
    ++quads;
  }
  EXPECT_EQ(quads, 16U);
}

TEST(RepositoryScenes, InteriorIsLargeAndItsCameraStandsInside) {
  const Scene scene = load_scene(kRoot / "scenes/interior", {});
  EXPECT_GE(scene.triangles.size(), 5000U);
  EXPECT_TRUE(inside(bounds(scene), scene.camera.value_or(Camera{}).eye));
}

class ForeignScenes : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kForeign)) GTEST_SKIP() << "there is no " << kForeign << ": nothing checked";
  }
};

TEST_F(ForeignScenes, CornellBoxesLoad) {
  const auto folder = kForeign / "cornell_mcguire";
  EXPECT_EQ(load_scene(folder / "CornellBox-Original.obj", {}).triangles.size(), 32U) << "4 of 36 are duplicates";
  EXPECT_EQ(load_scene(folder / "CornellBox-Glossy.obj", {}).triangles.size(), 1112U);
  const Scene spheres = load_scene(folder / "CornellBox-Sphere.obj", {});
  EXPECT_EQ(spheres.triangles.size(), 2188U);
  EXPECT_EQ(std::count_if(spheres.materials.begin(), spheres.materials.end(),
                          [](const SceneMaterial& m) { return m.kind != SurfaceKind::diffuse; }),
            2);
  for (const char* name : {"CornellBox-Original.obj", "CornellBox-Glossy.obj", "CornellBox-Sphere.obj"})
    EXPECT_NO_THROW(check_renderable(load_scene(folder / name, {})));
}

TEST_F(ForeignScenes, WithoutLightAreRefusedAndTheStudioHelps) {
  SceneOptions studio;
  studio.studio = true;
  for (const char* name : {"cornell_embree/cornell_box.obj", "models/teapot.obj", "models/stanford-bunny.obj"}) {
    SCOPED_TRACE(name);
    EXPECT_THROW(check_renderable(load_scene(kForeign / name, {})), InputError);
    const Scene scene = load_scene(kForeign / name, studio);
    EXPECT_NO_THROW(check_renderable(scene));
    EXPECT_TRUE(inside(bounds(scene), scene.camera.value_or(Camera{}).eye)) << "the camera stands in the room";
  }
}

TEST_F(ForeignScenes, GltfIsRefusedWithWhatIsAllowed) {
  try {
    load_scene(kForeign / "cornell_gltf/cornellBox.gltf", {});
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("a folder with scene.toml, a .toml"));
  }
}

TEST(Studio, RoomIsClosedFacesInwardsAndHoldsTheUsersCamera) {
  MemoryFiles files({{"a.obj", kTriangle}});
  SceneOptions options;
  options.studio = true;
  options.camera = Camera{{7, 3, -9}, {0, 0, 0}, {0, 1, 0}, 40};
  const Scene scene = load_scene_from(files, "a.obj", options);
  EXPECT_TRUE(inside(bounds(scene), {7, 3, -9}));
  EXPECT_THAT(inspect(scene), IsEmpty());
  EXPECT_NO_THROW(check_renderable(scene));
  // The triangle, six walls and a lamp.
  EXPECT_EQ(scene.triangles.size(), 1U + 12U + 2U);
  for (std::size_t t = 1; t < 13; ++t) {
    const auto& p = scene.triangles[t].position;
    const Vec3d a = scene.positions[p[0]];
    const Vec3d normal = vec::cross(vec::subtract(scene.positions[p[1]], a), vec::subtract(scene.positions[p[2]], a));
    EXPECT_GT(vec::dot(normal, vec::subtract({0.5, 0.5, 0}, a)), 0) << "wall " << t << " faces inwards";
  }
}

TEST(Studio, AMeshWithoutAreaIsRefused) {
  for (const std::string mesh : {"v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n", "v 0 0 0\nv 1 0 0\n", ""}) {
    EXPECT_THROW(load_texts({{"a.obj", mesh}}, "a.obj", true), InputError) << mesh;
  }
}

TEST(Studio, NamesOfFoldersWithoutSceneAreExplained) {
  try {
    load_scene(kRoot / "tests/data", {});
    FAIL() << "was accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("there is no scene.toml in this folder"));
  }
}

}  // namespace
}  // namespace torolux
