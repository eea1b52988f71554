// SPDX-License-Identifier: MIT
// `torolux profile` from outside: what it prints and writes, what it refuses, and what it tells of a run that fails.
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.hpp"
#include "tests/unit/host_tools/cli/run_main.hpp"

namespace torolux {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing_support::TemporaryFolder;

std::string image(const std::string& name) {
  return (std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (name + ".elf")).string();
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

Outcome profile(const std::string& name, std::vector<std::string> options) {
  options.insert(options.begin(), {"profile", image(name)});
  return torolux(options);
}

TEST(ProfileCommand, PrintsTheCostliestFunctions) {
  const Outcome run = profile("known_calls", {"--pes", "2x1", "--most", "5"});
  EXPECT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.out, AllOf(HasSubstr("cycles of 2 PEs until each had ended"), HasSubstr("[waits: receive]"),
                             HasSubstr("\n... and "), Not(HasSubstr("by_tail"))));
  const Outcome one = profile("known_calls", {"--pes", "2x1", "--pes-of", "1"});
  EXPECT_THAT(one.out,
              AllOf(HasSubstr("cycles of 1 PE until"), HasSubstr("waits_for_it"), Not(HasSubstr("all_calls"))));
}

TEST(ProfileCommand, WritesItsFiles) {
  const TemporaryFolder folder;
  const auto in_folder = [&](const char* name) { return (folder.path() / name).string(); };
  const Outcome run =
      profile("known_calls", {"--pes", "2x1", "--json", in_folder("a.json"), "--csv", in_folder("a.csv"), "--folded",
                              in_folder("a.folded"), "--speedscope", in_folder("a.speedscope"), "--report",
                              in_folder("a.html"), "--stats", in_folder("stats.json")});
  ASSERT_EQ(run.code, 0) << run.err;
  const auto json = nlohmann::json::parse(text_of(in_folder("a.json")));
  const auto stats = nlohmann::json::parse(text_of(in_folder("stats.json")));
  std::uint64_t self = 0, waits = 0;
  for (const auto& function : json.at("functions")) {
    self += function.at("self_cycles").get<std::uint64_t>();
    waits += function.at("wait_cycles").get<std::uint64_t>();
  }
  EXPECT_EQ(json.at("cycles"), self);
  EXPECT_EQ(json.at("wait_cycles"), waits);
  EXPECT_EQ(json.at("busy_cycles"), stats.at("busy_cycles"));
  EXPECT_THAT(text_of(in_folder("a.csv")), HasSubstr("\n\"countdown\",4,45,0,45,0,1,22.5,45,0\n"));
  EXPECT_THAT(text_of(in_folder("a.folded")), HasSubstr(";all_calls;by_pointer;leaf 3\n"));
  EXPECT_EQ(nlohmann::json::parse(text_of(in_folder("a.speedscope"))).at("profiles").size(), 3U);
  EXPECT_THAT(text_of(in_folder("a.html")), HasSubstr("\"profile\":{\"pes\":2,"));
}

TEST(ProfileCommand, RefusesWhatCannotBe) {
  EXPECT_EQ(profile("known_calls", {"--engine", "qemu"}).code, 1);
  EXPECT_EQ(profile("known_calls", {"--qemu-pes", "0"}).code, 1);
  EXPECT_EQ(profile("known_calls", {"--most", "0"}).code, 2);
  const Outcome pe = profile("known_calls", {"--pes", "2x1", "--pes-of", "0,2"});
  EXPECT_EQ(pe.code, 2);
  EXPECT_THAT(pe.err, HasSubstr("there is no PE 2; the machine has 0 to 1"));
  const TemporaryFolder folder;
  const std::string file = (folder.path() / "same").string();
  EXPECT_EQ(profile("known_calls", {"--csv", file, "--folded", file}).code, 2);
  EXPECT_EQ(profile("known_calls", {"--json", (folder.path() / "none" / "a.json").string()}).code, 2);
}

TEST(ProfileCommand, OfARunThatFailsTellsWhatHadHappened) {
  const Outcome run = profile("faults", {"--pes", "1x1"});
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.err, HasSubstr("PE 0: trap"));
  EXPECT_THAT(run.out, HasSubstr("commit_fault"));
}

}  // namespace
}  // namespace torolux
