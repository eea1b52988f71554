// SPDX-License-Identifier: MIT
// What `torolux info` predicts, against renders: on machines of several shapes, and for all that makes paths longer:
// lobes, mirrors, glass, shadow rays, a draft.
#include <gtest/gtest.h>

#include "host_tools/settings/presets.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

struct Shape {
  const char* scene;
  unsigned columns, rows;
  std::uint32_t cells;  ///< along each axis
  Scheme scheme = Scheme::spread;
};

class Prediction : public testing::TestWithParam<Shape> {};

TEST_P(Prediction, IsWithinAFactorOfTwo) {
  RenderCase render_case = native_case(source_dir() / "scenes" / GetParam().scene);
  render_case.quality.hemicube = 8;
  render_case.quality.shot_points = 1;
  render_case.quality.unshot = 0.1;
  render_case.quality.patch_length = 200;
  render_case.quality.element_length = 100;
  render_case.machine.description = {};
  render_case.machine.engine = kDefaultEngine;
  render_case.machine.columns = GetParam().columns;
  render_case.machine.rows = GetParam().rows;
  take_scheme(render_case.machine, GetParam().scheme);
  render_case.machine.subspaces = {GetParam().cells, GetParam().cells, GetParam().cells};
  const RenderFigures figures = run_case(render_case).figures;
  const Scene scene = load_scene(render_case.scene, {});
  const auto& prediction =
      plan(scene, scene.camera.value(), render_case.quality, render_case.machine, pe_image()).prediction;

  const auto expect_near = [](double predicted, double measured, const char* what) {
    EXPECT_GT(predicted, measured / 2) << what;
    EXPECT_LT(predicted, measured * 2) << what;
  };
  expect_near(static_cast<double>(prediction.shots), static_cast<double>(figures.shots), "shots");
  expect_near(prediction.records, static_cast<double>(figures.radiosity_records), "records");
  expect_near(prediction.radiosity_cycles, static_cast<double>(figures.radiosity_cycles), "radiosity stage");
  expect_near(prediction.cycles(),
              static_cast<double>(figures.load_cycles + figures.radiosity_cycles + figures.ray_tracing_cycles), "all");
  expect_near(prediction.instructions, static_cast<double>(figures.machine.instructions()), "instructions");
}
INSTANTIATE_TEST_SUITE_P(Machines, Prediction,
                         testing::Values(Shape{"cornell_box", 1, 1, 4}, Shape{"cornell_box", 4, 4, 8},
                                         Shape{"cornell_box", 2, 3, 5}, Shape{"cornell_spheres", 2, 2, 8},
                                         Shape{"cornell_box", 1, 1, 4, Scheme::paper},
                                         Shape{"cornell_box", 4, 4, 8, Scheme::paper},
                                         Shape{"cornell_spheres", 2, 2, 8, Scheme::paper}),
                         [](const auto& shape) {
                           return std::string(shape.param.scene) + "_" + std::to_string(shape.param.columns) + "x" +
                                  std::to_string(shape.param.rows) +
                                  (shape.param.scheme == Scheme::paper ? "_paper" : "");
                         });

struct Effect {
  const char* name;
  const char* scene;
  double refine;
  bool shadow_rays;
  Scheme scheme = Scheme::spread;
};

class PredictionOfEffects : public testing::TestWithParam<Effect> {};

// At less than a draft's effort, on 2x2 PEs. Seen: records within 6 %, virtual time of the radiosity stage and of the
// draft within 8 %, of the ray tracing stage within 22 %, which has the fewest rays to even out what 4000 paths of the
// prediction find.
TEST_P(PredictionOfEffects, IsWithinAQuarter) {
  RenderCase render_case = native_case(source_dir() / "scenes" / GetParam().scene);
  const Scene scene = load_scene(render_case.scene, {});
  Quality& quality = render_case.quality;
  apply(kPresets[0], quality);
  quality.patch_length = scene.defaults.given.values().quality.patch_length;
  quality.element_length = scene.defaults.given.values().quality.element_length;
  for (auto* length : {&quality.patch_length, &quality.element_length}) {
    if (*length) **length *= 4;
  }
  quality.patch_factor = quality.element_factor = 4;
  // A draft has a quarter of the points: with less than two across, starts and ends of rounds are most of its time.
  quality.shot_points = GetParam().refine > 0 ? 8 : 2;
  quality.emission_records = GetParam().refine > 0 ? 800'000 : 100'000;
  quality.width = quality.height = 128;
  quality.refine = GetParam().refine;
  quality.shadow_rays = GetParam().shadow_rays;
  render_case.machine.description = {};
  render_case.machine.engine = kDefaultEngine;
  render_case.machine.columns = render_case.machine.rows = 2;
  take_scheme(render_case.machine, GetParam().scheme);
  render_case.machine.subspaces = {8, 8, 8};
  const RenderFigures figures = run_case(render_case).figures;
  const auto& prediction = plan(scene, scene.camera.value(), quality, render_case.machine, pe_image()).prediction;

  const auto expect_near = [](double predicted, auto measured, const char* what) {
    EXPECT_NEAR(predicted / static_cast<double>(measured), 1, 0.25) << what;
  };
  expect_near(prediction.records, figures.radiosity_records, "records");
  expect_near(prediction.radiosity_cycles, figures.radiosity_cycles, "radiosity stage");
  expect_near(prediction.rays, figures.rays, "camera rays");
  expect_near(prediction.ray_tracing_cycles, figures.ray_tracing_cycles, "ray tracing stage");
  expect_near(prediction.instructions, figures.machine.instructions(), "instructions");
  EXPECT_EQ(prediction.draft_records > 0, GetParam().refine > 0);
  if (GetParam().refine > 0) {
    expect_near(prediction.draft_records, figures.draft_records, "records of the draft");
    expect_near(prediction.draft_cycles, figures.draft_cycles, "draft");
  }
}
INSTANTIATE_TEST_SUITE_P(Scenes, PredictionOfEffects,
                         testing::Values(Effect{"draft", "cornell_box", 0.5, false},
                                         Effect{"lobes", "glossy_floor", 0, false},
                                         Effect{"mirrors", "two_mirrors", 0, false},
                                         Effect{"lobes_paper", "glossy_floor", 0, false, Scheme::paper},
                                         Effect{"shadow_rays_paper", "cornell_box", 0, true, Scheme::paper},
                                         Effect{"shadow_rays", "cornell_box", 0, true}),
                         [](const auto& effect) { return std::string(effect.param.name); });

}  // namespace
}  // namespace torolux::test
