// SPDX-License-Identifier: MIT
// Sky and sun against theory: irradiance on a level plate, by the elements and by shadow rays; the sun's own rays, in
// its shadow, behind a pane, and in the layer of irradiance; the same picture on any machine; and a room with a window
// against the path tracer.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <numbers>
#include <string>

#include "tests/physics/lit_scenes.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

RenderCase plate(bool shadow_rays) {
  RenderCase result = native_case(data_dir() / "scenes" / "under_the_sky");
  result.quality.width = result.quality.height = 16;
  result.quality.samples = 64;
  result.quality.patch_length = 1;
  result.quality.element_length = 0.5;
  result.quality.hemicube = 8;
  result.quality.shot_points = 4;
  result.quality.emission_records = 1'000'000;
  result.quality.shadow_rays = shadow_rays;
  result.machine.subspaces = {2, 2, 2};
  return result;
}

std::array<double, 3> mean_of(const Picture& picture) {
  std::array<double, 3> mean{};
  for (const auto& pixel : picture.pixels)
    for (std::size_t c = 0; c < 3; ++c) mean[c] += double{pixel[c]} / static_cast<double>(picture.pixels.size());
  return mean;
}

class Plate : public testing::TestWithParam<bool> {};

// Under a sky of radiance 2 a level plate has pi * 2, of a sun at 30 degrees half of what one that faces it has; it
// sends half of that on, over pi. Seen: 0.3 %, the noise of the sky's records.
TEST_P(Plate, HasTheIrradianceOfTheory) {
  const RenderResult result = run_case(plate(GetParam()));
  const std::array<double, 3> seen = mean_of(result.picture);
  const std::array<double, 3> sun{10, 5, 0};
  for (std::size_t c = 0; c < 3; ++c) {
    const double expected = 0.5 * (std::numbers::pi * 2 + 0.5 * sun[c]) / std::numbers::pi;
    EXPECT_NEAR(seen[c] / expected, 1, 0.01) << c;
  }
  EXPECT_LT(energy_error(result.figures.energy), 1e-5);
  EXPECT_EQ(result.figures.credits_home, result.figures.credits_total);
}
INSTANTIATE_TEST_SUITE_P(Ways, Plate, testing::Bool(),
                         [](const auto& way) { return way.param ? "ShadowRays" : "Elements"; });

// A camera that looks past the plate sees the sky.
TEST(Sky, IsSeenWhereNothingIsBefore) {
  RenderCase past = plate(true);
  Camera camera;
  camera.eye = {0, 0.5, 3};
  camera.look_at = {0, 3, 0};
  camera.field_of_view_degrees = 10;
  past.camera = camera;
  for (const auto& pixel : run_case(past).picture.pixels)
    for (const float channel : pixel) EXPECT_NEAR(channel, 2, 1e-3);
}

TEST(Sky, IsTheSameOnAnyMachine) {
  RenderCase one = plate(true);
  one.quality.samples = 4;
  one.quality.emission_records = 50'000;
  expect_same_on_another_machine(one);
}

/// A plate under a sky of radiance 2 and, if asked for, a sun fifty times as strong; what else stands there is
/// `others`.
class SunnyPlate : public testing::Test {
 protected:
  RenderCase with(const std::string& others, bool sun) {
    std::ofstream(folder_.path() / "scene.toml")
        << "[[quad]]\ncorner = [-1, 0, 1]\nedges = [[2, 0, 0], [0, 0, -2]]\nmaterial = 'grey'\n"
           "[material.grey]\ndiffuse = 0.5\n[material.black]\ndiffuse = 0\n"
           "[material.window]\nglass = 1.5\nthin = true\n"
        << others << "[sky]\nradiance = 2\nground = 0\n"
        << (sun ? "[sky.sun]\nelevation = 30\nazimuth = 180\nirradiance = 300\n" : "")
        << "[camera]\neye = [0, 3, 0.5]\nlook_at = [0, 0, 0]\nfov = 20\n";
    RenderCase result = plate(true);
    result.scene = folder_.path();
    result.quality.samples = 16;
    result.quality.emission_records = 100'000;
    return result;
  }

 private:
  testing_support::TemporaryFolder folder_;
};

/// Of pixels' green, of its mean.
double spread_of(const Picture& picture) {
  const double mean = mean_of(picture)[1];
  double squares = 0;
  for (const auto& pixel : picture.pixels) squares += (pixel[1] - mean) * (pixel[1] - mean);
  return std::sqrt(squares / static_cast<double>(picture.pixels.size())) / mean;
}

// The board darkens all that is seen from the sun, which stands in the south (+z). Light and noise there are those of
// a day without sun: spreads of 256 pixels differ by 9 % of chance. When the sun was one emitter among others the noise
// was three times as large.
TEST_F(SunnyPlate, HasTheSkysLightInTheSunsShadow) {
  const std::string board = "[[quad]]\ncorner = [-3, 0, 1]\nedges = [[6, 0, 0], [0, 2, 0]]\nmaterial = 'black'\n";
  const Picture sunny = run_case(with(board, true)).picture;
  const Picture dull = run_case(with(board, false)).picture;
  EXPECT_NEAR(mean_of(sunny)[1] / mean_of(dull)[1], 1, 0.01);
  EXPECT_LT(spread_of(sunny), 1.3 * spread_of(dull));
}

// Behind a pane its reflection waits, so that of sun and sky one is taken by chance: the mean stays that of the
// elements. Chance: 256 pixels of 16 samples that are 0 or twice as much, 0.02 without stratification.
TEST_F(SunnyPlate, HasTheSameMeanBehindAPane) {
  const std::string pane = "[[quad]]\ncorner = [-2, 1, 2]\nedges = [[4, 0, 0], [0, 0, -4]]\nmaterial = 'window'\n";
  RenderCase behind = with(pane, true);
  const double by_rays = mean_of(run_case(behind).picture)[1];
  behind.quality.shadow_rays = false;
  EXPECT_NEAR(by_rays / mean_of(run_case(behind).picture)[1], 1, 0.03);
}

// Nothing but sun and sky lights the plate, and it sends on half of that, over pi: so both rays are in the layer.
TEST_F(SunnyPlate, HasAllOfItsLightInTheLayerOfIrradiance) {
  RenderCase layered = with("", true);
  const auto colours = bytes_of(run_case(layered).picture);
  layered.quality.layers = protocol::plane_bit(protocol::Plane::irradiance);
  const RenderResult result = run_case(layered);
  EXPECT_EQ(bytes_of(result.picture), colours) << "a layer changes no colour";
  ASSERT_EQ(result.layers.size(), 1U);
  for (std::size_t p = 0; p < result.picture.pixels.size(); ++p) {
    const double expected = double{result.picture.pixels[p][1]} * std::numbers::pi / 0.5;
    EXPECT_NEAR(double{result.layers[0].values[p][1]} / expected, 1, 1e-4) << p;
  }
}

// Seen: mean +0.3 %.
TEST(Sky, LightsARoomThroughItsWindow) {
  RenderCase room = native_case(source_dir() / "scenes" / "morning_room");
  room.quality.width = 48;
  room.quality.height = 32;
  room.quality.samples = 16;
  room.quality.patch_length = 1;
  room.quality.element_length = 0.25;
  room.quality.hemicube = 8;
  room.quality.shot_points = 4;
  room.quality.unshot = 0.005;
  room.quality.shadow_rays = true;
  room.machine.subspaces = {4, 4, 4};
  const references::PictureError error = beside_path_tracer(room).error;
  EXPECT_NEAR(error.plain_mean, 0, 0.03);
  EXPECT_LT(error.rmse, 0.15);
}

}  // namespace
}  // namespace torolux::test
