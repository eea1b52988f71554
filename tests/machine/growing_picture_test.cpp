// SPDX-License-Identifier: MIT
// Proves: a run that is shown in a viewer and by previews is the same run; the viewer's picture is the file's in the
// end; a preview is there before the picture is.
#include <gmock/gmock.h>

#include <csignal>
#include <thread>

#include "host_tools/picture/picture.hpp"
#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"
#include "tests/support/viewer_reader.hpp"

namespace torolux::test {
namespace {

using testing_support::TemporaryFolder;
using testing_support::ViewerReader;
using Arguments = std::vector<std::string>;

Arguments render_arguments(const Arguments& more) {
  Arguments arguments = small_render_options();
  arguments.insert(arguments.begin(), {"render", std::string(TOROLUX_SOURCE_DIR) + "/scenes/cornell_box", "--quiet"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(GrowingPicture, LeavesTheRunAsItIsAndArrivesWhole) {
  const TemporaryFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  const Finished without = run_torolux(render_arguments(
      {"--output", file("a.exr"), "--output", file("a.png"), "--layers", "all", "--stats", file("a.json")}));
  ASSERT_EQ(without.exit_code, 0) << without.errors;
  const ViewerReader viewer;
  const Finished with =
      run_torolux(render_arguments({"--output", file("b.exr"), "--output", file("b.png"), "--layers", "all", "--stats",
                                    file("b.json"), "--preview", "0.1", "--display-server", viewer.address()}));
  ASSERT_EQ(with.exit_code, 0) << with.errors;
  EXPECT_EQ(contents(file("a.exr")), contents(file("b.exr")));
  EXPECT_EQ(contents(file("a.png")), contents(file("b.png")));
  EXPECT_EQ(contents(file("a_cost.png")), contents(file("b_cost.png")));
  EXPECT_EQ(statistics(file("a.json")), statistics(file("b.json")));

  viewer.wait_for_end();
  EXPECT_EQ(viewer.fault(), "");
  const auto pictures = viewer.pictures();
  ASSERT_TRUE(pictures.contains("cornell_box"));
  const auto& seen = pictures.at("cornell_box");
  EXPECT_EQ(seen.channels.size(), 13U) << "R G B, and those of six layers";
  const Picture picture = read_picture(file("b.exr"));
  ASSERT_EQ(seen.width, static_cast<std::int32_t>(picture.width));
  for (std::size_t i = 0; i < picture.pixels.size(); ++i) {
    ASSERT_EQ(seen.channels.at("R")[i], picture.pixels[i][0]) << i;
    ASSERT_EQ(seen.channels.at("G")[i], picture.pixels[i][1]) << i;
    ASSERT_EQ(seen.channels.at("B")[i], picture.pixels[i][2]) << i;
  }
}

TEST(GrowingPicture, ThePreviewIsThereBeforeTheEnd) {
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.path() / "a.png";
  ToroluxProcess process(
      render_arguments({"--output", file.string(), "--preview", "0.1", "--samples", "4096", "--size", "256x256"}));
  while (!std::filesystem::exists(file)) {
    ASSERT_TRUE(process.errors_so_far().empty()) << process.errors_so_far();
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  process.signal(SIGINT);
  EXPECT_EQ(process.wait().exit_code, 130);
  EXPECT_THAT(contents(file), testing::StartsWith("\x89PNG"));
}

TEST(GrowingPicture, APreviewOfNothingIsRefused) {
  const TemporaryFolder folder;
  const Finished finished = run_torolux(render_arguments({"--output", folder.path() / "a.exr", "--preview", "1"}));
  EXPECT_EQ(finished.exit_code, 1);
  EXPECT_THAT(finished.errors, testing::HasSubstr("--preview"));
}

}  // namespace
}  // namespace torolux::test
