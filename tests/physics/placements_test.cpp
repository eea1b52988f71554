// SPDX-License-Identifier: MIT
// One picture and one solution, whoever holds copies of what, wherever rays stop, and whoever makes a point's records.
#include <gtest/gtest.h>

#include <cstring>
#include <tuple>

#include "emulator/machine/machine.hpp"
#include "host_tools/render/frame_layers.hpp"
#include "host_tools/render/setup.hpp"
#include "host_tools/stages/render_program.hpp"
#include "tests/support/render_support.hpp"

namespace torolux::test {
namespace {

/// Copies of all; stops in empty subspaces, too; points travel.
using Choice = std::tuple<bool, bool, bool>;

struct Made {
  std::string picture;          ///< digest of the frame buffer's sums
  std::vector<std::byte> flux;  ///< of the solution: elements, patch sides
  protocol::Tally tally{};
};

/// The scene's radiosity stage and a picture, with subspaces that stand where and records that are made by whom
/// `choice` says.
Made render_as(const std::string& name, const std::string& engine, unsigned pes, const Choice& choice) {
  RenderCase made = native_case(source_dir() / "scenes" / name);
  made.quality.shot_points = 2;
  made.quality.max_shots = 20;
  made.quality.shadow_rays = true;
  made.machine.engine = engine;
  made.machine.columns = pes;
  made.machine.description.records.credits_per_pe = 64;
  const Scene scene = load_scene(made.scene, {});
  const Image image = load_image(pe_image());
  RenderSetup setup = make_setup(scene, made.quality, made.machine, image);
  setup.placement = make_placement(setup.mesh, {.torus = {pes, 1},
                                                .subspaces = std::array<std::uint32_t, 3>{5, 4, 6},
                                                .copy_all = std::get<0>(choice),
                                                .stop_everywhere = std::get<1>(choice)});
  const MemoryNeed need = memory_need(setup.mesh, setup.placement, setup.parameters, setup.map);
  RadiositySettings radiosity = radiosity_settings(scene, setup, made.quality);
  radiosity.points_travel = std::get<2>(choice);
  RenderProgram program({scene,
                         setup,
                         radiosity,
                         CameraRays(*scene.camera, setup.mesh.space, made.quality.width, made.quality.height,
                                    PixelSamples(made.quality.filter, 1, 1), 1),
                         {setup.credits, made.quality.width, made.quality.height, 1, true}});
  MachineSetup machine;
  machine.description = made.machine.description;
  machine.columns = pes;
  machine.rows = 1;
  machine.local_memory_bytes = choose_memory(need, {}).value();
  machine.engine = engine;
  machine.frame_width = made.quality.width;
  machine.frame_height = made.quality.height;
  Machine torolux(machine, image);
  torolux.run(program);
  Made result;
  result.picture = digest_of(torolux.frame_buffer(), protocol::Plane::colour);
  const Solution& solution = program.solution().value();
  balance(scene, setup.mesh, setup.units, solution);  // throws where flux is lost
  const auto add = [&result](const auto& items) {
    const auto bytes = std::as_bytes(std::span(items));
    result.flux.insert(result.flux.end(), bytes.begin(), bytes.end());
  };
  add(solution.elements);
  add(solution.sides);
  result.tally = solution.tally;
  return result;
}

class Placements : public testing::TestWithParam<Choice> {};

TEST_P(Placements, MakeTheSamePictureAndSolution) {
  static const Made one = render_as("cornell_spheres", "native", 1, {false, false, false});
  for (const char* engine : {"native", "translated"}) {
    const Made made = render_as("cornell_spheres", engine, 6, GetParam());
    EXPECT_EQ(made.picture, one.picture) << engine;
    EXPECT_EQ(made.flux, one.flux) << engine;
    EXPECT_EQ(std::memcmp(&made.tally, &one.tally, sizeof one.tally), 0) << engine;
  }
}

INSTANTIATE_TEST_SUITE_P(All, Placements, testing::Combine(testing::Bool(), testing::Bool(), testing::Bool()),
                         [](const auto& choice) {
                           return std::string(std::get<0>(choice.param) ? "copies" : "spread") +
                                  (std::get<1>(choice.param) ? "_stops" : "_steps_over") +
                                  (std::get<2>(choice.param) ? "_points_travel" : "_points_stay");
                         });

}  // namespace
}  // namespace torolux::test
