// SPDX-License-Identifier: MIT
// One picture, whatever the machine: PEs, allocations, subspace grids, links and credits change figures, never a byte.
#include <gtest/gtest.h>

#include <cstdio>
#include <string>

#include "tests/physics/same_picture.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

class Torus : public testing::TestWithParam<std::pair<unsigned, unsigned>> {};

// The draft, its splits and the fine mesh are the same on any machine; so is a view of saved radiosities, which carry
// the splits.
TEST(Refinement, IsTheSameOnAnyMachine) {
  const testing_support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "radiosities";
  RenderCase cornell = small_cornell();
  cornell.quality.refine = 1;
  cornell.machine.columns = cornell.machine.rows = 1;
  cornell.files.save_radiosity = file;
  const RenderResult one = run_case(cornell);
  expect_all_home(one);
  EXPECT_GT(one.figures.splits, 10U);
  EXPECT_GT(one.figures.draft_cycles, 0U);
  cornell.files = {};
  cornell.machine.columns = 3;
  cornell.machine.rows = 2;
  cornell.machine.subspaces = {5, 3, 4};
  EXPECT_EQ(bytes_of(run_case(cornell).picture), bytes_of(one.picture));
  cornell.files.radiosity = file;
  EXPECT_EQ(bytes_of(run_case(cornell).picture), bytes_of(one.picture));
}

TEST_P(Torus, MakesTheSamePicture) {
  RenderCase cornell = small_cornell("cornell_spheres");
  std::tie(cornell.machine.columns, cornell.machine.rows) = GetParam();
  expect_same_picture(cornell);
}
INSTANTIATE_TEST_SUITE_P(Sizes, Torus,
                         testing::Values(std::pair{1U, 1U}, std::pair{4U, 4U}, std::pair{3U, 5U}, std::pair{1U, 8U},
                                         std::pair{8U, 8U}),
                         [](const auto& size) {
                           return std::to_string(size.param.first) + "x" + std::to_string(size.param.second);
                         });

// In little memory all PEs have shapes, and one alone the surface of each that is seldom seen. In 1.5 MiB not even all
// shapes fit on every PE, nor on each owner of a subspace all surfaces that it meets there: that would be 2.7 MB.
TEST(Memory, SurfacesThatAreKeptDoNotShow) {
  RenderCase interior = native_case(source_dir() / "scenes/interior");
  interior.quality.max_shots = 4;
  interior.quality.samples = 2;
  interior.machine = {};
  interior.machine.engine = "translated";
  interior.machine.columns = interior.machine.rows = 4;
  interior.machine.pe_memory = 16U << 20U;
  const RenderResult whole = run_case(interior);
  expect_all_home(whole);
  EXPECT_EQ(whole.figures.ray_tracing_copies.kept, 0U);
  for (const std::uint32_t kibibytes : {4096U, 1536U}) {
    interior.machine.pe_memory = kibibytes << 10U;
    const RenderResult kept = run_case(interior);
    expect_all_home(kept);
    EXPECT_GT(kept.figures.ray_tracing_copies.kept, 100U);
    EXPECT_EQ(bytes_of(kept.picture), bytes_of(whole.picture)) << kibibytes;
  }
}

/// Host, NIUs and signals that cost nothing, as much as they should, a hundred times that.
TEST(Costs, NeverChangeThePicture) {
  RenderCase ideal = small_cornell("cornell_spheres");
  ideal.machine.description.ideal = {.host = true, .niu = true, .signals = true};
  expect_same_picture(ideal);
  RenderCase dear = small_cornell("cornell_spheres");
  MachineDescription& machine = dear.machine.description;
  machine.host.cost_factor = 100;
  machine.bus.signal_cycles *= 100;
  machine.bus.arbitration_cycles *= 100;
  machine.frame_buffer.cycles_per_pixel *= 100;
  machine.niu = {.bytes_per_cycle = 1, .receive_packets = 1};
  expect_same_picture(dear);
}

class Allocation : public testing::TestWithParam<const char*> {};

TEST_P(Allocation, MakesTheSamePicture) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.machine.columns = 3;
  cornell.machine.allocation = GetParam();
  expect_same_picture(cornell);
}
INSTANTIATE_TEST_SUITE_P(Names, Allocation, testing::Values("skewed", "skewed-both", "modulo", "block", "balanced"),
                         [](const auto& name) {
                           std::string text = name.param;
                           for (char& c : text) c = c == '-' ? '_' : c;
                           return text;
                         });

/// How a scene and the work on it are shared out: the published scheme, or copies on every PE of nothing, of some, of
/// all subspaces, with points and tiles dealt to whoever has little; or one scheme with steps of the other.
struct Sharing {
  const char* name;
  MachineChoice machine;
};

template <class Change>
Sharing sharing(const char* name, Scheme scheme, Change change) {
  Sharing result{name, {}};
  take_scheme(result.machine, scheme);
  change(result.machine);
  return result;
}

class Shared : public testing::TestWithParam<Sharing> {};

TEST_P(Shared, MakesTheSamePictureAndRadiosities) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.quality.shot_points = 3;  // shots of many points, which may travel
  cornell.quality.shadow_rays = true;
  static const Solved one = solve([&cornell] {
    RenderCase alone = cornell;
    alone.machine.columns = alone.machine.rows = 1;
    return alone;
  }());
  EXPECT_GT(one.radiosities.size(), 1000U);
  cornell.machine = GetParam().machine;
  cornell.machine.columns = 3;
  cornell.machine.rows = 2;
  cornell.machine.subspaces = {5, 4, 6};
  for (const auto& [engine, credits] : {std::pair{"native", 1U}, {"translated", 64U}}) {
    cornell.machine.engine = engine;
    cornell.machine.description.records.credits_per_pe = credits;
    const Solved other = solve(cornell);
    EXPECT_EQ(other.picture, one.picture) << engine;
    EXPECT_EQ(other.radiosities, one.radiosities) << engine;
  }
}
INSTANTIATE_TEST_SUITE_P(
    Schemes, Shared,
    testing::Values(sharing("paper", Scheme::paper, [](MachineChoice&) {}),
                    sharing("no_copies", Scheme::spread, [](MachineChoice& m) { m.replicate = 0; }),
                    sharing("some_copies", Scheme::spread, [](MachineChoice& m) { m.replicate = 0.02; }),
                    sharing("copies", Scheme::spread, [](MachineChoice&) {}),
                    sharing("paper_points_travel", Scheme::paper, [](MachineChoice& m) { m.points = Points::travel; }),
                    sharing("paper_over_empty_with_tiles", Scheme::paper,
                            [](MachineChoice& m) {
                              m.empty = Empty::over;
                              m.camera_rays = RayMaker::pes;
                            }),
                    sharing("paper_copies_enter_outermost", Scheme::paper,
                            [](MachineChoice& m) {
                              m.replicate = 0.02;
                              m.skip_empty_subspaces = false;
                            }),
                    sharing("points_stay", Scheme::spread, [](MachineChoice& m) { m.points = Points::stay; }),
                    sharing("enter_empty_no_copies", Scheme::spread,
                            [](MachineChoice& m) {
                              m.empty = Empty::enter;
                              m.replicate = 0;
                            }),
                    sharing("host_rays_enter_outermost", Scheme::spread,
                            [](MachineChoice& m) {
                              m.camera_rays = RayMaker::host;
                              m.skip_empty_subspaces = false;
                            })),
    [](const auto& sharing) { return sharing.param.name; });

class Grid : public testing::TestWithParam<std::array<std::uint32_t, 3>> {};

TEST_P(Grid, MakesTheSamePicture) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.machine.subspaces = GetParam();
  expect_same_picture(cornell);
}
INSTANTIATE_TEST_SUITE_P(Sizes, Grid,
                         testing::Values(std::array<std::uint32_t, 3>{1, 1, 1}, std::array<std::uint32_t, 3>{8, 8, 8},
                                         std::array<std::uint32_t, 3>{5, 3, 7}),
                         [](const auto& grid) {
                           return std::to_string(grid.param[0]) + "x" + std::to_string(grid.param[1]) + "x" +
                                  std::to_string(grid.param[2]);
                         });

class Materials : public testing::TestWithParam<const char*> {};

/// Glossy surfaces, textures and glass around diffuse surfaces, with shadow rays.
TEST_P(Materials, MakeTheSamePicture) {
  RenderCase room = native_case(data_dir() / "scenes" / GetParam());
  room.quality.hemicube = 8;
  room.quality.shot_points = 1;
  room.quality.max_shots = 60;
  room.quality.patch_length = 0.3;
  room.quality.element_length = 0.1;
  room.quality.shadow_rays = true;
  const RenderResult reference = run_case(room);
  expect_all_home(reference);

  RenderCase many = room;
  many.machine.columns = 5;
  many.machine.rows = 3;
  many.machine.subspaces = {5, 3, 7};
  many.machine.allocation = "balanced";
  many.machine.description.records.credits_per_pe = 40;
  RenderCase few = room;
  few.machine.columns = few.machine.rows = 2;
  few.machine.subspaces = {2, 2, 2};
  few.machine.description.records.credits_per_pe = 3;
  few.machine.description.torus.link_error_rate = 0.05;
  RenderCase translated = many;
  translated.machine.engine = "translated";
  for (const RenderCase& other : {many, few, translated}) {
    const RenderResult result = run_case(other);
    expect_all_home(result);
    EXPECT_EQ(bytes_of(result.picture), bytes_of(reference.picture)) << other.machine.engine;
  }
}
INSTANTIATE_TEST_SUITE_P(Rooms, Materials, testing::Values("glossy_room", "textured_room", "glass_block"),
                         [](const auto& name) { return std::string(name.param); });

TEST(Links, LatencyAndDelaysDoNotShow) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.machine.description.torus.link_cycles = 37;
  cornell.machine.description.torus.flit_bytes = 4;
  cornell.machine.description.jitter = {.seed = 1, .cycles = 900};
  expect_same_picture(cornell);
}

TEST(Links, FaultsAreRepairedAndDoNotShow) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.machine.description.torus.link_error_rate = 0.05;
  const RenderResult result = run_case(cornell);
  expect_all_home(result);
  EXPECT_EQ(bytes_of(result.picture), reference_picture());
  EXPECT_GT(result.figures.machine.link_retries, 0U);
}

/// The seeds of `--jitter`; the soak takes a hundred.
class Jittered : public testing::TestWithParam<std::uint32_t> {};

TEST_P(Jittered, DelaysOfLinksRoutersAndBusDoNotShow) {
  RenderCase cornell = small_cornell("cornell_spheres");
  const std::string still = exact_figures(run_case(cornell).figures);
  cornell.machine.description.jitter.seed = GetParam();
  cornell.machine.description.torus.link_error_rate = GetParam() % 2 * 0.1;
  const RenderResult result = run_case(cornell);
  expect_all_home(result);
  EXPECT_EQ(bytes_of(result.picture), reference_picture());
  EXPECT_NE(exact_figures(result.figures), still) << "it is to change the cycles";
}
INSTANTIATE_TEST_SUITE_P(Seeds, Jittered, testing::Values(1, 2, 3));

TEST(Credits, FewMakeTheSamePicture) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.machine.description.records.credits_per_pe = 4;
  expect_same_picture(cornell);
}

TEST(Credits, ManyWithFewSlotsAreDivertedAndMakeTheSamePicture) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.machine.description.records.credits_per_pe = 2000;
  cornell.machine.description.records.niu_slots = 16;
  const RenderResult result = run_case(cornell);
  expect_all_home(result);
  EXPECT_EQ(bytes_of(result.picture), reference_picture());
  std::uint64_t diverted = 0;
  for (const PeFigures& pe : result.figures.machine.pes) diverted += pe.records_diverted;
  EXPECT_GT(diverted, 0U) << "the test is to force diversion";
}

/// With shadow rays in place of the elements' direct light: another picture, and again the same one on every machine.
TEST(ShadowRays, MakeTheSamePicture) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.quality.shadow_rays = true;
  cornell.quality.samples = 2;
  const std::vector<std::byte> bytes = bytes_of(run_case(cornell).picture);
  EXPECT_NE(bytes, reference_picture());
  const auto same = [&bytes](const RenderCase& other) {
    const RenderResult result = run_case(other);
    expect_all_home(result);
    EXPECT_EQ(bytes_of(result.picture), bytes);
    return exact_figures(result.figures);
  };
  RenderCase one = cornell;
  one.machine.columns = one.machine.rows = 1;
  one.machine.subspaces = {1, 1, 1};
  same(one);
  RenderCase other = cornell;
  other.machine.columns = 3;
  other.machine.rows = 5;
  other.machine.subspaces = {5, 3, 7};
  other.machine.allocation = "balanced";
  other.machine.description.jitter = {.seed = 1, .cycles = 900};
  same(other);
  cornell.machine.engine = "qemu";
  const std::string figures = same(cornell);
  cornell.machine.engine = "translated";
  EXPECT_EQ(same(cornell), figures);
}

/// Layers change no byte of the colours, and are themselves the same on every machine, but for those of the machine.
TEST(Layers, MakeTheSamePictureAndAreTheSame) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.quality.layers = (1U << protocol::kPlanes) - 2U;
  const RenderResult result = run_case(cornell);
  expect_all_home(result);
  EXPECT_EQ(bytes_of(result.picture), reference_picture());
  ASSERT_EQ(result.layers.size(), protocol::kPlanes - 1U);
  cornell.machine.columns = 3;
  cornell.machine.rows = 5;
  cornell.machine.subspaces = {5, 3, 7};
  const RenderResult other = run_case(cornell);
  EXPECT_EQ(bytes_of(other.picture), reference_picture());
  for (std::size_t i = 0; i < result.layers.size(); ++i) {
    const Layer& layer = result.layers[i];
    const bool of_the_machine = layer.plane == protocol::Plane::owner || layer.plane == protocol::Plane::cost;
    EXPECT_EQ(layer.values, other.layers[i].values) << name_of(layer.plane);
    EXPECT_EQ(layer.numbers == other.layers[i].numbers, !of_the_machine) << name_of(layer.plane);
  }
  // Who finds a surface hangs on whom the tile was dealt to, and so on cycles, which native code does not have.
  std::vector<RenderResult> by_cycles;
  for (const char* engine : {"qemu", "translated"}) {
    cornell.machine.engine = engine;
    by_cycles.push_back(run_case(cornell));
    const RenderResult& again = by_cycles.back();
    EXPECT_EQ(bytes_of(again.picture), reference_picture()) << engine;
    for (std::size_t i = 0; i < again.layers.size(); ++i) {
      const bool owner = again.layers[i].plane == protocol::Plane::owner;
      EXPECT_EQ(again.layers[i].values, other.layers[i].values) << engine;
      EXPECT_EQ(again.layers[i].numbers, (owner ? by_cycles.front() : other).layers[i].numbers) << engine;
    }
  }
}

/// Which pixels get more samples is chosen by integers that every machine has alike; each is divided by its own number.
TEST(AdaptiveSamples, MakeTheSamePictureAndChooseTheSamePixels) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.quality.samples = 4;
  cornell.quality.most_samples = 16;
  cornell.quality.noise = 4;
  cornell.quality.layers = protocol::plane_bit(protocol::Plane::irradiance);
  cornell.machine.columns = cornell.machine.rows = 1;
  const RenderResult one = run_case(cornell);
  expect_all_home(one);
  const std::uint64_t pixels = std::uint64_t{cornell.quality.width} * cornell.quality.height;
  EXPECT_GT(one.figures.rays, 9 * pixels / 2) << "some pixels have more";
  EXPECT_LT(one.figures.rays, 14 * pixels) << "and some have not";
  const auto expect_same = [&](const char* engine, unsigned columns, unsigned rows,
                               std::array<std::uint32_t, 3> subspaces) {
    cornell.machine.engine = engine;
    cornell.machine.columns = columns;
    cornell.machine.rows = rows;
    cornell.machine.subspaces = subspaces;
    const RenderResult other = run_case(cornell);
    expect_all_home(other);
    EXPECT_EQ(bytes_of(other.picture), bytes_of(one.picture)) << engine << " " << columns << "x" << rows;
    EXPECT_EQ(other.figures.picture_sha256, one.figures.picture_sha256);
    EXPECT_EQ(other.figures.rays, one.figures.rays);
    EXPECT_EQ(other.layers[0].values, one.layers[0].values);
  };
  expect_same("native", 4, 4, {5, 3, 7});
  expect_same("translated", 3, 2, {4, 4, 4});
  expect_same("qemu", 2, 2, {2, 6, 3});
}

/// Where no block asks for more, the picture is that of the least samples; where all do, that of the most.
TEST(AdaptiveSamples, LieBetweenTheLeastAndTheMost) {
  RenderCase cornell = small_cornell();
  cornell.quality.samples = 2;
  cornell.quality.most_samples = 8;
  cornell.quality.noise = 100;
  const std::uint64_t least = run_case(cornell).figures.rays;
  cornell.quality.noise = 0;
  const RenderResult most = run_case(cornell);
  cornell.quality.samples = 4;
  const std::uint64_t twice = [&] {
    cornell.quality.noise = 100;
    return run_case(cornell).figures.rays;
  }();
  EXPECT_NEAR(static_cast<double>(twice), 2.0 * static_cast<double>(least), 0.01 * static_cast<double>(twice));
  EXPECT_GT(most.figures.rays, 3 * least);
  EXPECT_LE(most.figures.rays, std::uint64_t{8} * cornell.quality.width * cornell.quality.height);
}

}  // namespace
}  // namespace torolux::test
