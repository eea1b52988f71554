// SPDX-License-Identifier: MIT
// Final gathering finds the light that shots bring, with less noise; the same on every machine.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <string>

#include "tests/physics/same_picture.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

double mean_of(const Picture& picture) {
  double sum = 0;
  for (const auto& pixel : picture.pixels) sum += pixel[0] + pixel[1] + pixel[2];
  return sum / static_cast<double>(picture.pixels.size());
}

struct Room {
  const char* scene;
  bool shadow_rays;
};

class Gathered : public testing::TestWithParam<Room> {
 protected:
  static RenderCase room() {
    const std::string name = GetParam().scene;
    const bool in_scenes = std::filesystem::exists(source_dir() / "scenes" / name);
    RenderCase render_case = native_case((in_scenes ? source_dir() / "scenes" : data_dir() / "scenes") / name);
    render_case.quality.shadow_rays = GetParam().shadow_rays;
    render_case.quality.emission_records = 400'000;
    render_case.quality.hemicube = 4;
    render_case.quality.shot_points = 6;
    render_case.quality.unshot = 0.005;
    return render_case;
  }
};

// Mirrors, glass, panes, lobes, textures, lamps and a sky: what gathering does not find is kept apart, and nothing is
// counted twice. Lobes and caustics are the noisiest; the rest differs by less than 0.4 %.
TEST_P(Gathered, IsAsBrightAsWhatWasShot) {
  RenderCase render_case = room();
  const double shot = mean_of(run_case(render_case).picture);
  render_case.quality.final_gather = 96;
  const RenderResult result = run_case(render_case);
  expect_all_home(result);
  EXPECT_NEAR(mean_of(result.picture), shot, 0.01 * shot);
}
INSTANTIATE_TEST_SUITE_P(Rooms, Gathered,
                         testing::Values(Room{"cornell_box", true}, Room{"cornell_box", false},
                                         Room{"cornell_spheres", true}, Room{"cornell_spheres", false},
                                         Room{"glass_block", true}, Room{"glossy_room", true},
                                         Room{"textured_room", true}, Room{"post_room", true},
                                         Room{"under_the_sky", true}, Room{"under_the_sky", false},
                                         Room{"wall_washer", true}, Room{"morning_room", true}, Room{"furnace", false}),
                         [](const auto& room) {
                           return std::string(room.param.scene) +
                                  (room.param.shadow_rays ? "_shadow_rays" : "_radiosity");
                         });

RenderCase small_gathering(const char* scene) {
  RenderCase cornell = small_cornell(scene);
  cornell.quality.hemicube = 4;
  cornell.quality.shot_points = 3;
  cornell.quality.shadow_rays = true;
  cornell.quality.final_gather = 48;
  return cornell;
}

// Whoever makes the rays, wherever they go: elements add up the same answers. Saved, they come back.
TEST(FinalGather, IsTheSameOnAnyMachine) {
  RenderCase alone = small_gathering("cornell_spheres");
  alone.machine.columns = alone.machine.rows = 1;
  const Solved one = solve(alone);
  RenderCase shot = alone;
  shot.quality.final_gather = 0;
  EXPECT_NE(solve(shot).picture, one.picture);
  for (const Scheme scheme : {Scheme::paper, Scheme::spread}) {
    RenderCase many = small_gathering("cornell_spheres");
    take_scheme(many.machine, scheme);
    many.machine.columns = 3;
    many.machine.rows = 2;
    many.machine.subspaces = {5, 4, 6};
    many.machine.description.records.credits_per_pe = scheme == Scheme::paper ? 3 : 64;
    many.machine.description.jitter = {.seed = 1, .cycles = 900};
    const Solved other = solve(many);
    EXPECT_EQ(other.picture, one.picture);
    EXPECT_EQ(other.radiosities, one.radiosities);
  }
  const testing_support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "radiosities";
  std::ofstream(file, std::ios::binary) << one.radiosities;
  alone.files.radiosity = file;
  EXPECT_EQ(bytes_of(run_case(alone).picture), one.picture);
}

TEST(FinalGather, TakesTheSameCyclesOnEveryEngine) {
  RenderCase cornell = small_gathering("cornell_box");
  cornell.quality.max_shots = 10;
  cornell.machine.engine = "translated";
  const Solved translated = solve(cornell);
  cornell.machine.engine = "qemu";
  const Solved qemu = solve(cornell);
  EXPECT_EQ(qemu.figures, translated.figures);
  EXPECT_EQ(qemu.radiosities, translated.radiosities);
  cornell.machine.engine = "native";
  EXPECT_EQ(solve(cornell).radiosities, translated.radiosities);
}

// Where all walls are alike every ray finds the same, what they emit and what they reflect: no noise is left but that
// of the shots' light where a ray ends, half of the light there, and of it the mean of 96 elements.
TEST(FinalGather, LeavesAFurnaceLessNoise) {
  RenderCase furnace = native_case(data_dir() / "scenes" / "furnace");
  furnace.quality.patch_length = 0.75;
  furnace.quality.element_length = 0.4;
  furnace.quality.shot_points = 8;
  furnace.quality.hemicube = 4;
  furnace.quality.unshot = 2e-4;
  furnace.quality.shadow_rays = false;
  const auto error = [](const RenderResult& result) {
    double squares = 0;
    for (const auto& pixel : result.picture.pixels) {
      for (const float channel : pixel) squares += std::pow((channel - 2.0) / 2.0, 2);
    }
    return std::sqrt(squares / (3.0 * static_cast<double>(result.picture.pixels.size())));
  };
  const double shot = error(run_case(furnace));
  furnace.quality.final_gather = 96;
  EXPECT_LT(error(run_case(furnace)), 0.3 * shot);
}

// What is left unshot is estimated; rays that find emission must not have that estimated once more. Half a percent: the
// estimate is exact where all walls are alike, and what is left is noise of 10^5 records.
TEST(FinalGather, IsAsBrightWhereMuchIsUnshot) {
  RenderCase furnace = native_case(data_dir() / "scenes" / "furnace");
  furnace.quality.shot_points = 4;
  furnace.quality.hemicube = 4;
  furnace.quality.emission_records = 125'000;
  furnace.quality.unshot = 0.1;
  furnace.quality.shadow_rays = false;
  furnace.quality.final_gather = 96;
  double sum = 0;
  const RenderResult result = run_case(furnace);
  for (const auto& pixel : result.picture.pixels) sum += static_cast<double>(pixel[0] + pixel[1] + pixel[2]) / 3;
  EXPECT_NEAR(sum / static_cast<double>(result.picture.pixels.size()), 2.0, 0.01);
}

}  // namespace
}  // namespace torolux::test
