// SPDX-License-Identifier: MIT
// Small pictures of whole scenes against the path tracer. The long form is the target `accuracy`.
#include <gtest/gtest.h>

#include "tests/references/picture_error.hpp"
#include "tests/support/render_support.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

struct Errors {
  double mean, rmse, noise;
};

references::TracedPicture traced(const RenderCase& render_case, std::uint32_t paths) {
  const Scene scene = load_scene(render_case.scene, {});
  references::TraceChoice choice;
  choice.width = render_case.quality.width;
  choice.height = render_case.quality.height;
  choice.samples = paths;
  return references::trace(references::World(scene, false), scene.camera.value(), choice);
}

Errors errors_of(const RenderCase& render_case, const references::TracedPicture& reference) {
  const auto error = references::picture_error(run_case(render_case).picture, reference.picture);
  return {error.plain_mean, error.rmse, references::reference_noise(reference)};
}

Errors errors_of(const RenderCase& render_case, std::uint32_t paths) {
  return errors_of(render_case, traced(render_case, paths));
}

RenderCase small(const char* name, double patches) {
  RenderCase result = native_case(source_dir() / "scenes" / name);
  result.quality.width = result.quality.height = 64;
  result.quality.samples = 4;
  result.quality.patch_length = patches;
  result.quality.element_length = 50;
  result.quality.hemicube = 8;
  result.quality.shot_points = 4;
  result.quality.unshot = 0.005;  // what is left is missing in the picture
  result.machine.subspaces = {4, 4, 4};
  return result;
}

// Seen: mean +0.5 %, RMSE 6.5 %; 1 % and 5 % are wanted, by finer settings. The greater part of it lies at the feet of
// the blocks, where elements reach into the shadow, and in corners, where interpolation between them is too bright.
TEST(TracedPicture, CornellBox) {
  const Errors errors = errors_of(small("cornell_box", 200), 512);
  EXPECT_LT(errors.noise, 0.01);
  EXPECT_NEAR(errors.mean, 0, 0.015);
  EXPECT_LT(errors.rmse, 0.08);
}

// Seen: mean +1.0 %, RMSE 9.5 %, 2.7 % of it noise; 1 % and 7 % are wanted, by finer settings. The rest lies in the
// caustic and under the spheres.
TEST(TracedPicture, CornellSpheres) {
  const Errors errors = errors_of(small("cornell_spheres", 200), 512);
  EXPECT_LT(errors.noise, 0.035);
  EXPECT_NEAR(errors.mean, 0, 0.02);
  EXPECT_LT(errors.rmse, 0.115);
}

RenderCase small_by_shadow_rays(const char* name) {
  RenderCase result = small(name, 200);
  result.quality.shadow_rays = true;
  result.quality.samples = 16;
  return result;
}

// Seen: mean -0.8 %, RMSE 5.5 %. Shadows are right now; what is left is light by way of walls on coarse elements.
TEST(TracedPicture, CornellBoxByShadowRays) {
  const Errors errors = errors_of(small_by_shadow_rays("cornell_box"), 512);
  EXPECT_LT(errors.noise, 0.01);
  EXPECT_NEAR(errors.mean, 0, 0.015);
  EXPECT_LT(errors.rmse, 0.065);
}

// Seen: mean -0.7 %, RMSE 8.9 %, 2.7 % of it noise. Were the light by way of mirror and glass left out with the direct
// light, or counted by shadow rays as well, the mean would be off by 5 % and more.
TEST(TracedPicture, CornellSpheresByShadowRays) {
  const Errors errors = errors_of(small_by_shadow_rays("cornell_spheres"), 512);
  EXPECT_LT(errors.noise, 0.035);
  EXPECT_NEAR(errors.mean, 0, 0.02);
  EXPECT_LT(errors.rmse, 0.105);
}

double mean_of(const Picture& picture) {
  double sum = 0;
  for (const auto& pixel : picture.pixels) sum += pixel[0] + pixel[1] + pixel[2];
  return sum / static_cast<double>(3 * picture.pixels.size());
}

// Both ways bring the same light: on surfaces without glass or mirrors before them only the noise of the picture (and
// what interpolation does at shadows' edges) lies between them. Of the very same radiosities, so nothing else differs.
TEST(ShadowRays, BringAsMuchLightAsElements) {
  const testing_support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "radiosities";
  RenderCase box = small("cornell_box", 100);
  box.quality.element_length = 25;
  box.quality.samples = 8;
  box.files.save_radiosity = file;
  const double by_elements = mean_of(run_case(box).picture);
  box.files = {.save_radiosity = std::nullopt, .save_mesh = std::nullopt, .radiosity = file};
  box.quality.shadow_rays = true;
  const double by_shadow_rays = mean_of(run_case(box).picture);
  EXPECT_NEAR(by_shadow_rays / by_elements, 1, 0.003);
}

/// Of the tests' own scenes, in rooms of edge 1.
RenderCase small_room(const char* name) {
  RenderCase result = native_case(data_dir() / "scenes" / name);
  result.quality.width = result.quality.height = 64;
  result.quality.samples = 16;
  result.quality.patch_length = 0.25;
  result.quality.element_length = 0.07;
  result.quality.unshot = 0.003;
  result.machine.subspaces = {4, 4, 4};
  return result;
}

// A glossy floor under a glossy block: by exponents 60 and 8, in both stages. Seen: mean +0.1 %, RMSE 2.7 %; with
// shadow rays -0.1 %, 1.6 %.
TEST(TracedPicture, GlossyRoom) {
  RenderCase room = small_room("glossy_room");
  const references::TracedPicture reference = traced(room, 256);
  for (const bool shadow_rays : {false, true}) {
    room.quality.shadow_rays = shadow_rays;
    const Errors errors = errors_of(room, reference);
    EXPECT_LT(errors.noise, 0.01);
    EXPECT_NEAR(errors.mean, 0, 0.01) << shadow_rays;
    EXPECT_LT(errors.rmse, 0.04) << shadow_rays;
  }
}

// A diffuse block inside a glass one: radiance changes with the refractive index. Seen: mean -0.5 to +0.3 %, RMSE 4.4
// to 5.3 % by seed (2.2 % when the ceiling was still meshed by the file's own sixteen triangles). It is noise of
// emission: its 200,000 records would be some 2.8 x 2.8 points of each patch that emits, and are cut down to 2 x 2,
// half as many. With 300,000 (3 x 3) and more it falls fast, to 1.9 % with 800,000 (5 x 5).
TEST(TracedPicture, DiffuseBlockInGlass) {
  RenderCase room = small_room("glass_block");
  const Errors errors = errors_of(room, 256);
  EXPECT_LT(errors.noise, 0.02);
  EXPECT_NEAR(errors.mean, 0, 0.01);
  EXPECT_LT(errors.rmse, 0.07);
}

// Textures on a floor, a wall, and a wall that is glossy besides. Seen: mean +0.1 %, RMSE 3.8 %; with shadow rays
// -0.3 %, 1.9 %.
TEST(TracedPicture, TexturedRoom) {
  RenderCase room = small_room("textured_room");
  room.quality.hemicube = 8;
  room.quality.shot_points = 4;
  room.quality.patch_length = 0.15;  // a patch reflects the mean of what is seen on it
  room.quality.unshot = 0.0015;      // light walls: the unshot rest would be reflected several times
  const references::TracedPicture reference = traced(room, 256);
  for (const bool shadow_rays : {false, true}) {
    room.quality.shadow_rays = shadow_rays;
    const Errors errors = errors_of(room, reference);
    EXPECT_LT(errors.noise, 0.02);
    EXPECT_NEAR(errors.mean, 0, 0.01) << shadow_rays;
    EXPECT_LT(errors.rmse, 0.05) << shadow_rays;
  }
}

}  // namespace
}  // namespace torolux::test
