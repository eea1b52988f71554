// SPDX-License-Identifier: MIT
// Proves: the Cornell box is the same scene from glTF as from OBJ; each of the models that Debian ships for Assimp's
// tests, broken ones too, is loaded or refused with its name, and some of them are what they should be.
#include <cmath>

#include "host_tools/scene/vec.hpp"
#include "tests/support/written_scenes.hpp"
#include "tests/unit/host_tools/scene/scene_text.hpp"

namespace torolux {
namespace {

namespace fs = std::filesystem;

TEST(GltfScenes, TheCornellBoxIsTheSameAsFromObj) {
  const Scene obj = load_scene(fs::path(TOROLUX_SOURCE_DIR) / "scenes/cornell_box", {});
  const Scene gltf = load_texts({{"box.glb", as_glb(obj)}}, "box.glb");
  ASSERT_EQ(gltf.triangles.size(), obj.triangles.size());
  ASSERT_EQ(gltf.materials.size(), obj.materials.size());
  for (std::size_t t = 0; t < obj.triangles.size(); ++t) {
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t axis = 0; axis < 3; ++axis)
        // Floats of 24 bits, and coordinates up to 560.
        EXPECT_NEAR(gltf.positions[gltf.triangles[t].position[i]][axis],
                    obj.positions[obj.triangles[t].position[i]][axis], 5e-5);
    const SceneMaterial& a = gltf.materials[gltf.triangles[t].material];
    const SceneMaterial& b = obj.materials[obj.triangles[t].material];
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.kind, b.kind);
    EXPECT_EQ(a.diffuse, b.diffuse);
    EXPECT_EQ(a.specular, b.specular);
    for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(a.emission[c], b.emission[c], 1e-12);
  }
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_NEAR(gltf.camera->eye[axis], obj.camera->eye[axis], 1e-9);
  EXPECT_NEAR(gltf.camera->field_of_view_degrees, obj.camera->field_of_view_degrees, 1e-9);
  EXPECT_GT(gltf.camera->look_at[2], gltf.camera->eye[2]);
}

class AssimpModels : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kFolder)) GTEST_SKIP() << "the Debian package assimp-testmodels is not installed";
  }
  static Scene load(const char* name) { return load_scene(kFolder / name, {}); }
  inline static const fs::path kFolder = "/usr/share/assimp/models";
};

TEST_F(AssimpModels, AreLoadedOrRefusedByName) {
  int loaded = 0;
  int refused = 0;
  for (const auto& entry : fs::recursive_directory_iterator(kFolder)) {
    const std::string extension = entry.path().extension().string();
    if (extension != ".gltf" && extension != ".glb") continue;
    try {
      load_scene(entry.path(), {});
      ++loaded;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::StartsWith(entry.path().string() + ": "));
      ++refused;
    }
  }
  EXPECT_GT(loaded, 20);
  EXPECT_GT(refused, 10);
}

TEST_F(AssimpModels, AreWhatTheyShouldBe) {
  EXPECT_EQ(load("glTF2/BoxTextured-glTF-Binary/BoxTextured.glb").triangles.size(), 12U);
  EXPECT_EQ(load("glTF2/BoxTextured-glTF/BoxTextured.gltf").textures.at(0).width, 211U);
  EXPECT_EQ(load("glTF2/BoxTextured-glTF-Embedded/BoxTextured.gltf").textures.size(), 1U);
  const Scene cameras = load("glTF2/cameras/Cameras.gltf");
  EXPECT_NEAR(cameras.camera->field_of_view_degrees, 40.1, 0.1);
}

}  // namespace
}  // namespace torolux
