// SPDX-License-Identifier: MIT
// `torolux inspect` as a user sees it: text and JSON say the same, saved radiosities give the same answer without the
// radiosity stage, and what cannot be answered is refused before the work.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;
using testing_support::TemporaryFolder;
using Arguments = std::vector<std::string>;

Arguments small(const std::string& command, const Arguments& more) {
  Arguments arguments = small_render_options();
  arguments.insert(arguments.begin(), {command, std::string(TOROLUX_SOURCE_DIR) + "/scenes/cornell_box"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

TEST(Inspect, AnswersAsTextAndJson) {
  const TemporaryFolder folder;
  const auto file = [&](const char* name) { return (folder.path() / name).string(); };
  const Arguments questions = {"--pixel", "8,6", "--pe", "1", "--element", "8,6", "--quiet"};
  Arguments first = questions;
  first.insert(first.end(), {"--json", file("a.json"), "--view", file("a.png")});
  const Finished run = run_torolux(small("inspect", first));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  const auto json = nlohmann::json::parse(contents(file("a.json")));
  const std::string element = std::to_string(json["element"]["element"].get<unsigned>());
  EXPECT_THAT(run.output, HasSubstr("sees                  element " + element));
  EXPECT_EQ(json["pixel"]["element"], json["element"]["element"]);
  EXPECT_THAT(run.output, HasSubstr("PE                    1, column 1, row 0"));
  EXPECT_EQ(json["pe"]["stages"].size(), 2U);
  EXPECT_GT(json["pe"]["stages"][0]["figures"]["busy_cycles"], 0);
  EXPECT_GT(json["pe"]["stages"][1]["figures"]["busy_cycles"], 0);
  EXPECT_THAT(contents(file("a.png")), testing::StartsWith("\x89PNG"));

  ASSERT_EQ(run_torolux(small("render", {"--no-picture", "--save-radiosity", file("a.rad"), "--quiet"})).exit_code, 0);
  const Finished again = run_torolux(
      small("inspect", {"--element", element, "--radiosity", file("a.rad"), "--quiet", "--json", file("b.json")}));
  ASSERT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(nlohmann::json::parse(contents(file("b.json")))["element"], json["element"]);
}

TEST(Inspect, RefusesWhatThereIsNot) {
  EXPECT_EQ(run_torolux(small("inspect", {})).exit_code, 1);
  for (const auto& [question, complaint] : {std::pair("--pixel=16,0", "16 x 12 pixels"),
                                            {"--pe=4", "the machine has 0 to 3"},
                                            {"--element=99999999", "there is no element 99999999"},
                                            {"--pixel=3", "is not a pixel"}}) {
    const Finished run = run_torolux(small("inspect", {question, "--quiet"}));
    EXPECT_EQ(run.exit_code, 2) << question;
    EXPECT_THAT(run.errors, HasSubstr(complaint));
  }
}

}  // namespace
}  // namespace torolux::test
