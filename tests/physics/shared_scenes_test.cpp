// SPDX-License-Identifier: MIT
// Meshes from elsewhere (beside the checkout, where they are kept): each renders, or is refused for a reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "emulator/errors.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

struct MeshFile {
  const char* file;
  bool studio;  ///< it has no light or no surroundings of its own
};

class SharedScene : public testing::TestWithParam<MeshFile> {};

TEST_P(SharedScene, Renders) {
  const std::filesystem::path file = source_dir() / ".." / "shared" / "scenes" / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << file << " is not here";
  if (GetParam().studio) {
    EXPECT_THROW(check_renderable(load_scene(file, {})), InputError) << "no light";
  }
  SceneOptions options;
  options.studio = GetParam().studio;
  const Scene scene = load_scene(file, options);
  RenderCase small = native_case(file);
  small.quality.hemicube = 8;
  small.quality.shot_points = 1;
  small.quality.max_shots = 30;
  const RenderResult result =
      render(scene, scene.camera.value(), small.quality, small.machine, small.files, pe_image(), {});
  const bool lit = std::ranges::any_of(result.picture.pixels, [](const auto& pixel) { return pixel[0] > 0.0F; });
  EXPECT_TRUE(lit);
  EXPECT_LT(energy_error(result.figures.energy), 1e-5);
  EXPECT_EQ(result.figures.credits_home, result.figures.credits_total);
}
INSTANTIATE_TEST_SUITE_P(Meshes, SharedScene,
                         testing::Values(MeshFile{"cornell_mcguire/CornellBox-Original.obj", false},
                                         MeshFile{"cornell_mcguire/CornellBox-Sphere.obj", false},
                                         MeshFile{"cornell_mcguire/CornellBox-Glossy.obj", false},
                                         MeshFile{"cornell_gltf/cornellBox.gltf", false},
                                         MeshFile{"cornell_embree/cornell_box.obj", true},
                                         MeshFile{"models/teapot.obj", true},
                                         MeshFile{"models/stanford-bunny.obj", true}),
                         [](const auto& mesh) {
                           std::string name = std::filesystem::path(mesh.param.file).stem().string();
                           std::ranges::replace(name, '-', '_');
                           return name;
                         });

}  // namespace
}  // namespace torolux::test
