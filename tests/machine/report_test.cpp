// SPDX-License-Identifier: MIT
// Proves: a run is the same with a report as without one, the report is written whole, over nothing else, and its size
// is bounded.
#include <gtest/gtest.h>

#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using testing_support::TemporaryFolder;
using Arguments = std::vector<std::string>;

Finished render(const Arguments& more) {
  Arguments arguments = small_render_options();
  arguments.insert(arguments.begin(), {"render", std::string(TOROLUX_SOURCE_DIR) + "/scenes/cornell_box", "--quiet"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return run_torolux(arguments);
}

TEST(Report, LeavesTheRunAsItIs) {
  const TemporaryFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  const Finished without = render({"--output", file("a.png"), "--stats", file("a.json")});
  ASSERT_EQ(without.exit_code, 0) << without.errors;
  const Finished with = render({"--output", file("b.png"), "--stats", file("b.json"), "--report", file("b.html")});
  ASSERT_EQ(with.exit_code, 0) << with.errors;
  EXPECT_EQ(statistics(file("a.json")), statistics(file("b.json")));
  EXPECT_EQ(contents(file("a.png")), contents(file("b.png")));
  const std::string page = contents(file("b.html"));
  EXPECT_TRUE(page.starts_with("<!doctype html>"));
  EXPECT_TRUE(page.ends_with("</html>\n"));
  // Issue 15 allows 2 MB for 16 x 16 PEs; here are 16 at most, and a picture of some thousand pixels.
  EXPECT_LT(page.size(), 300'000U);
}

TEST(Report, IsNotWrittenOverAnotherResult) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "a";
  const Finished finished = render({"--no-picture", "--stats", file, "--report", file});
  EXPECT_EQ(finished.exit_code, 2);
  EXPECT_NE(finished.errors.find("--report"), std::string::npos) << finished.errors;
  EXPECT_FALSE(std::filesystem::exists(file));
}

TEST(Report, OfAnImageIsNotWrittenOverIt) {
  const TemporaryFolder folder;
  const std::string image = folder.path() / "hello.elf";
  std::filesystem::copy_file(std::string(TOROLUX_FIRMWARE_DIR) + "/hello.elf", image);
  const std::string before = contents(image);
  EXPECT_EQ(run_torolux({"run", image, "--quiet", "--report", image}).exit_code, 2);
  EXPECT_EQ(contents(image), before);
  const std::string file = folder.path() / "a.html";
  const Finished finished = run_torolux({"run", image, "--quiet", "--report", file});
  EXPECT_EQ(finished.exit_code, 0) << finished.errors;
  EXPECT_TRUE(contents(file).ends_with("</html>\n"));
}

}  // namespace
}  // namespace torolux::test
