// SPDX-License-Identifier: MIT
// Proves: `torolux rerun` repeats a run from its statistics alone, says whether it was the same, and refuses what has
// changed.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing_support::TemporaryFolder;

/// A render's statistics, and its scene in a folder that may be changed.
class Rerun : public testing::Test {
 protected:
  Rerun() {
    fs::copy(TOROLUX_SOURCE_DIR "/scenes/cornell_box", scene_, fs::copy_options::recursive);
    std::vector<std::string> arguments = {
        "render",  scene_, "--output", folder_.path() / "a.exr",    "--layers", "depth",
        "--stats", stats_, "--set",    "torus.link_error_rate=0.1", "--quiet"};
    for (const std::string& option : small_render_options()) arguments.push_back(option);
    const Finished run = run_torolux(arguments);
    EXPECT_EQ(run.exit_code, 0) << run.errors;
  }

  /// Writes the statistics with one place changed.
  std::string changed(const nlohmann::json::json_pointer& place, const nlohmann::json& value) {
    auto json = nlohmann::ordered_json::parse(contents(stats_));
    json[nlohmann::ordered_json::json_pointer(place.to_string())] = value;
    const std::string file = folder_.path() / "changed.json";
    std::ofstream(file) << json;
    return file;
  }

  const TemporaryFolder folder_;
  const std::string scene_ = folder_.path() / "box";
  const std::string stats_ = folder_.path() / "stats.json";
};

TEST_F(Rerun, IsTheSameOnAnyThreadsToTheByte) {
  const std::string picture = folder_.path() / "b.exr";
  const std::string again = folder_.path() / "again.json";
  const Finished run = run_torolux({"rerun", stats_, "--threads", "2", "--output", picture, "--stats", again});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(run.output, "cycles      the same\npicture     the same\ntrace hash  the same\n");
  EXPECT_EQ(contents(picture), contents(folder_.path() / "a.exr"));
  EXPECT_EQ(statistics(again), statistics(stats_));
}

TEST_F(Rerun, SaysWhatDiffersFirst) {
  const Finished run = run_torolux({"rerun", changed("/virtual_cycles/radiosity"_json_pointer, 7)});
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.output, HasSubstr("cycles      NOT the same\npicture     the same\n"));
  EXPECT_THAT(run.errors, HasSubstr("differs first in virtual_cycles.radiosity: was 7, is "));
  const Finished picture = run_torolux({"rerun", changed("/picture/sha256"_json_pointer, "abc")});
  EXPECT_EQ(picture.exit_code, 3);
  EXPECT_THAT(picture.output, HasSubstr("picture     NOT the same\ntrace hash  the same\n"));
}

TEST_F(Rerun, TellsOtherVersions) {
  const Finished run = run_torolux({"rerun", changed("/settings/versions/protocol"_json_pointer, 1)});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("note: versions.protocol: was 1, is "));
}

TEST_F(Rerun, RefusesChangedInputsUnlessTold) {
  std::ofstream(scene_ + "/cornell_box.mtl", std::ios::app) << "# nothing\n";
  const Finished refused = run_torolux({"rerun", stats_});
  EXPECT_EQ(refused.exit_code, 2);
  EXPECT_THAT(refused.errors, HasSubstr("cornell_box.mtl has changed"));
  EXPECT_THAT(refused.errors, HasSubstr("--changed-inputs"));
  EXPECT_EQ(run_torolux({"rerun", stats_, "--changed-inputs"}).exit_code, 0) << "a remark changes no light";
  EXPECT_EQ(run_torolux({"rerun", changed("/settings/inputs/3/sha256"_json_pointer, "abc")}).exit_code, 2)
      << "the firmware is an input";
}

TEST_F(Rerun, FindsASceneThatHasMovedOnlyIfTold) {
  const std::string moved = folder_.path() / "moved";
  fs::rename(scene_, moved);
  const Finished lost = run_torolux({"rerun", stats_});
  EXPECT_EQ(lost.exit_code, 2);
  EXPECT_THAT(lost.errors, HasSubstr("--scene"));
  EXPECT_EQ(run_torolux({"rerun", stats_, "--scene", moved}).exit_code, 0);
}

// By hand, or by a disk: the file is named, and nothing is taken for something else.
TEST_F(Rerun, OfSettingsThatAreWrongNamesTheFile) {
  const std::vector<std::pair<const char*, nlohmann::json>> wrong = {
      {"/settings/seed", -1},         {"/settings/exposure", -99},      {"/settings/pes", 3},
      {"/settings/engine", "steam"},  {"/settings/automatic", -1},      {"/settings/camera", nullptr},
      {"/settings/filter", "square"}, {"/settings/machine", {{"a", 1}}}};
  for (const auto& [place, value] : wrong) {
    const Finished run = run_torolux({"rerun", changed(nlohmann::json::json_pointer(place), value)});
    EXPECT_EQ(run.exit_code, 2) << place << ": " << run.errors;
    EXPECT_THAT(run.errors, HasSubstr("changed.json: ")) << place;
    EXPECT_THAT(run.errors, testing::Not(HasSubstr("\"18446744073709551"))) << place;
  }
}

TEST(RerunOfAnImage, IsTheSameOnTheOtherEngine) {
  const TemporaryFolder folder;
  const std::string stats = folder.path() / "stats.json";
  ASSERT_EQ(run_torolux({"run", std::string(TOROLUX_FIRMWARE_DIR) + "/token.elf", "--pes", "3x2", "--stats", stats,
                         "--set", "bus.arbitration_cycles=9"})
                .exit_code,
            0);
  const Finished run = run_torolux({"rerun", stats, "--engine", "qemu"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.output, HasSubstr("cycles      the same\ntrace hash  the same\n"));
}

// What the program got: its arguments and files. What it wrote is written again only by a run.
TEST(RerunOfAnImage, HasItsArgumentsAndFiles) {
  const TemporaryFolder folder;
  const std::string stats = folder.path() / "stats.json";
  const std::string plate = folder.path() / "plate.ppm";
  const std::string input = folder.path() / "input";
  std::ofstream(input) << "as it was";
  const Finished first =
      run_torolux({"run", std::string(TOROLUX_FIRMWARE_DIR) + "/heat.elf", "--pes", "2x2", "--stats", stats, "--input",
                   "a=" + input, "--output", "plate.ppm=" + plate, "--", "12", "20"});
  ASSERT_EQ(first.exit_code, 0) << first.errors;
  std::filesystem::remove(plate);
  const Finished again = run_torolux({"rerun", stats, "--engine", "interpreted"});
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(again.output, first.output + "cycles      the same\ntrace hash  the same\n");
  EXPECT_FALSE(std::filesystem::exists(plate));
  std::ofstream(input) << "otherwise";
  EXPECT_THAT(run_torolux({"rerun", stats}).errors, HasSubstr("input has changed"));
}

TEST(RerunOfAFile, ThatHoldsNoSettingsIsRefused) {
  const TemporaryFolder folder;
  const std::string file = folder.path() / "stats.json";
  for (const char* text : {"", "{", "[1]", "{}", "{\"settings\": {}}", "{\"settings\": {\"inputs\": []}}"}) {
    std::ofstream(file) << text;
    const Finished run = run_torolux({"rerun", file});
    EXPECT_EQ(run.exit_code, 2) << text;
    EXPECT_NE(run.errors, "");
  }
}

}  // namespace
}  // namespace torolux::test
