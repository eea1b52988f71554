// SPDX-License-Identifier: MIT
// Small pictures of whole scenes against the path tracer. The long form is the target `accuracy`.
#include <gtest/gtest.h>

#include "tests/references/picture_error.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

struct Errors {
  double mean, rmse, noise;
};

Errors errors_of(const RenderCase& render_case, std::uint32_t paths) {
  const Scene scene = load_scene(render_case.scene, {});
  references::TraceChoice choice;
  choice.width = render_case.quality.width;
  choice.height = render_case.quality.height;
  choice.samples = paths;
  const auto reference = references::trace(references::World(scene, false), scene.camera.value(), choice);
  const auto error = references::picture_error(run_case(render_case).picture, reference.picture);
  return {error.plain_mean, error.rmse, references::reference_noise(reference)};
}

RenderCase small(const char* name, double patches) {
  RenderCase result = native_case(source_dir() / "scenes" / name);
  result.quality.width = result.quality.height = 64;
  result.quality.samples = 4;
  result.quality.patch_length = patches;
  result.quality.element_length = 50;
  result.quality.hemicube = 12;
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

}  // namespace
}  // namespace torolux::test
