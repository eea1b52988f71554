// SPDX-License-Identifier: MIT
// What `torolux info` predicts, against renders: virtual time within a factor of two, on machines of several
// shapes.
#include <gtest/gtest.h>

#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

struct Shape {
  const char* scene;
  unsigned columns, rows;
  std::uint32_t cells;  ///< along each axis
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
                                         Shape{"cornell_box", 2, 3, 5}, Shape{"cornell_spheres", 2, 2, 8}),
                         [](const auto& shape) {
                           return std::string(shape.param.scene) + "_" + std::to_string(shape.param.columns) + "x" +
                                  std::to_string(shape.param.rows);
                         });

}  // namespace
}  // namespace torolux::test
