// SPDX-License-Identifier: MIT
// One picture and the same figures, to the last, whichever engine runs the PEs and on however many threads; and of
// saved radiosities the picture of a full run.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/physics/same_picture.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

RenderResult render_on(const char* engine, unsigned threads) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.machine.engine = engine;
  cornell.machine.threads = threads;
  cornell.machine.columns = cornell.machine.rows = 4;
  return run_case(cornell);
}

/// The reference engine: pe.elf itself on QEMU nodes makes the bytes that its handlers make natively. The translated
/// engine takes the same cycles besides, on as many threads as it likes.
TEST(Engine, TranslatedIsQemuToTheLastFigure) {
  const RenderResult qemu = render_on("qemu", 0);
  expect_all_home(qemu);
  EXPECT_EQ(bytes_of(qemu.picture), reference_picture());
  for (const unsigned threads : {1U, 2U, 3U, 1U, 3U}) {
    const RenderResult translated = render_on("translated", threads);
    EXPECT_EQ(bytes_of(translated.picture), reference_picture()) << threads << " threads";
    EXPECT_EQ(exact_figures(translated.figures), exact_figures(qemu.figures)) << threads << " threads";
  }
}

class EveryScene : public testing::TestWithParam<std::string> {};

/// The beginning of each scene's radiosity stage, and a small picture; tests/soak does it at the scenes' own quality.
TEST_P(EveryScene, TranslatedIsQemuToTheLastFigure) {
  RenderCase scene = native_case(source_dir() / "scenes" / GetParam());
  scene.quality.max_shots = 12;
  scene.machine = {};
  scene.machine.engine = "qemu";
  const RenderResult qemu = run_case(scene);
  expect_all_home(qemu);
  scene.machine.engine = "translated";
  const RenderResult translated = run_case(scene);
  EXPECT_EQ(bytes_of(translated.picture), bytes_of(qemu.picture));
  EXPECT_EQ(exact_figures(translated.figures), exact_figures(qemu.figures));
}
INSTANTIATE_TEST_SUITE_P(Names, EveryScene, testing::ValuesIn(scene_names()),
                         [](const auto& name) { return name.param; });

/// A thousand PEs in one process.
TEST(Engine, TranslatedTakesManyPes) {
  RenderCase cornell = small_cornell("cornell_spheres");
  cornell.machine.engine = "translated";
  cornell.machine.columns = cornell.machine.rows = 32;
  cornell.machine.subspaces = {32, 8, 32};
  expect_same_picture(cornell);
}

/// Same command, same bytes, same cycles and statistics, whatever the host's timing.
TEST(Repetition, FiguresAreExactlyTheSame) {
  RenderCase cornell = small_cornell("cornell_spheres");
  const RenderResult first = run_case(cornell);
  cornell.machine.threads = 1;
  const RenderResult second = run_case(cornell);
  EXPECT_EQ(exact_figures(first.figures), exact_figures(second.figures));
  EXPECT_EQ(bytes_of(first.picture), bytes_of(second.picture));
}

/// Saved radiosities with a second camera: the bytes of a full run with that camera, and no shots.
TEST(SavedRadiosity, ServesASecondCamera) {
  const testing_support::TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "radiosities";
  RenderCase first = small_cornell();
  first.files.save_radiosity = file;
  run_case(first);

  RenderCase full = small_cornell();
  full.camera = Camera{{400, 400, 100}, {100, 100, 500}, {0, 1, 0}, 60};
  RenderCase view = full;
  view.files.radiosity = file;
  const RenderResult of_full = run_case(full);
  const RenderResult of_view = run_case(view);
  EXPECT_EQ(bytes_of(of_full.picture), bytes_of(of_view.picture));
  EXPECT_EQ(of_view.figures.shots, 0U);
  EXPECT_GT(of_full.figures.shots, 0U);
}

}  // namespace
}  // namespace torolux::test
