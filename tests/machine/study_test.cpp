// SPDX-License-Identifier: MIT
// Proves: a study killed at any moment goes on and ends with the bytes of an uninterrupted one; what has been run is
// not run again, what has changed is; shards, processes side by side and commands run by hand lead to the same.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>
#include <thread>

#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

namespace fs = std::filesystem;
using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using testing::HasSubstr;
using testing_support::TemporaryFolder;

const std::string kPlan = TOROLUX_SOURCE_DIR "/tests/data/studies/token.toml";
constexpr std::size_t kRuns = 50;

std::string image(const std::string& name) {
  return std::string(TOROLUX_FIRMWARE_DIR) + "/" + name + ".elf";
}

std::vector<std::string> study(const std::string& plan, const fs::path& folder, std::vector<std::string> more = {}) {
  more.insert(more.begin(), {"study", plan, "--folder", folder.string()});
  return more;
}

std::size_t files_in(const fs::path& folder, const char* extension) {
  std::size_t count = 0;
  for (const auto& entry : fs::directory_iterator(folder)) count += entry.path().extension() == extension ? 1 : 0;
  return count;
}

/// Table and curves by name.
std::map<std::string, std::string> outputs_of(const fs::path& folder) {
  std::map<std::string, std::string> outputs;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string extension = entry.path().extension();
    if (extension == ".csv" || extension == ".svg") outputs[entry.path().filename()] = contents(entry.path());
  }
  return outputs;
}

/// Of a study that nobody has interrupted; run once for all tests.
const std::map<std::string, std::string>& undisturbed() {
  static const std::map<std::string, std::string> outputs = [] {
    const TemporaryFolder folder;
    const Finished run = run_torolux(study(kPlan, folder.path()));
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_THAT(run.errors, HasSubstr("50 points, 50 different runs: 0 were there, 50 started, 0 failed"));
    return outputs_of(folder.path());
  }();
  return outputs;
}

TEST(Study, TellsEveryRunInOneTableAndDrawsItsCurves) {
  const auto& outputs = undisturbed();
  ASSERT_EQ(outputs.size(), 4U);
  for (const char* name : {"cycles.svg", "speed_up.svg", "mean_hops.svg"})
    EXPECT_THAT(outputs.at(name), HasSubstr("</svg>")) << name;
  const std::string& table = outputs.at("results.csv");
  EXPECT_EQ(std::ranges::count(table, '\n'), 1 + static_cast<std::ptrdiff_t>(kRuns));
  EXPECT_THAT(table, testing::StartsWith("pes,machine.torus.flit_bytes,machine.torus.link_cycles,cycles,speed_up,"));
  // As `torolux run` itself says it.
  const TemporaryFolder folder;
  const std::string stats = folder.path() / "stats.json";
  ASSERT_EQ(run_torolux({"run", image("token"), "--pes", "4x2", "--set", "torus.flit_bytes=8", "--set",
                         "torus.link_cycles=10", "--stats", stats})
                .exit_code,
            0);
  const auto cycles = statistics(stats)["virtual_cycles"]["total"].get<std::uint64_t>();
  EXPECT_THAT(table, HasSubstr("\n4x2,8,10," + std::to_string(cycles) + ","));
}

TEST(Study, KilledTwiceGoesOnToTheBytesOfAnUninterruptedOne) {
  const TemporaryFolder folder;
  // Where a third and two thirds of the results are there, whatever the computer's speed.
  for (const std::size_t enough : {kRuns / 3, 2 * kRuns / 3}) {
    ToroluxProcess run(study(kPlan, folder.path(), {"--jobs", "2"}));
    const auto deadline = std::chrono::steady_clock::now() + 60s;
    while (files_in(folder.path(), ".json") < enough && std::chrono::steady_clock::now() < deadline)
      std::this_thread::sleep_for(1ms);
    run.signal(SIGKILL);
    EXPECT_EQ(run.wait().exit_code, 128 + SIGKILL);
    EXPECT_FALSE(fs::exists(folder.path() / "results.csv"));
  }
  const std::size_t there = files_in(folder.path(), ".json");
  EXPECT_LT(there, kRuns);
  const Finished last = run_torolux(study(kPlan, folder.path()));
  EXPECT_EQ(last.exit_code, 0) << last.errors;
  EXPECT_EQ(outputs_of(folder.path()), undisturbed());
  EXPECT_EQ(files_in(folder.path(), ".lock"), 0U);
}

TEST(Study, CtrlCEndsItsRunsAndLeavesNoLocks) {
  const TemporaryFolder folder;
  const std::string plan = folder.path() / "plan.toml";
  std::ofstream(plan) << "[base]\ncommand = 'render'\nscene = '" TOROLUX_SOURCE_DIR
                         "/scenes/cornell_box'\nquality = 'fine'\n[vary]\npes = ['2x2', '1x1']\n";
  const fs::path results = folder.path() / "results";
  ToroluxProcess run(study(plan, results, {"--jobs", "2"}));
  const std::vector<pid_t> children = run.children(2);
  ASSERT_EQ(children.size(), 2U);
  EXPECT_EQ(files_in(results, ".lock"), 2U);
  run.signal(SIGINT);
  EXPECT_EQ(run.wait().exit_code, 130);
  EXPECT_TRUE(all_gone(children));
  EXPECT_EQ(files_in(results, ".lock"), 0U);
  EXPECT_EQ(files_in(results, ".json"), 0U);
}

TEST(Study, WhatIsThereIsNotRunAgain) {
  const TemporaryFolder folder;
  ASSERT_EQ(run_torolux(study(kPlan, folder.path())).exit_code, 0);
  const Finished again = run_torolux(study(kPlan, folder.path()));
  EXPECT_THAT(again.errors, HasSubstr("50 were there, 0 started, 0 failed"));
  EXPECT_EQ(outputs_of(folder.path()), undisturbed());
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    if (entry.path().extension() != ".json") continue;
    std::ofstream(entry.path()) << "{\"half";
    break;
  }
  EXPECT_THAT(run_torolux(study(kPlan, folder.path())).errors, HasSubstr("49 were there, 1 started, 0 failed"))
      << "what is not whole is run again";
}

TEST(Study, TwoShardsAtOnceInOneFolderGiveTheSame) {
  const TemporaryFolder folder;
  ToroluxProcess first(study(kPlan, folder.path(), {"--shard", "1/2"}));
  ToroluxProcess second(study(kPlan, folder.path(), {"--shard", "2/2"}));
  const Finished one = first.wait();
  const Finished two = second.wait();
  EXPECT_EQ(one.exit_code, 0) << one.errors;
  EXPECT_EQ(two.exit_code, 0) << two.errors;
  EXPECT_THAT(one.errors + two.errors, testing::ContainsRegex("2[0-9] started.*2[0-9] started|25 started"));
  EXPECT_EQ(outputs_of(folder.path()), undisturbed());
}

TEST(Study, TwoProcessesShareItAndEachRunIsDoneOnce) {
  const TemporaryFolder folder;
  ToroluxProcess first(study(kPlan, folder.path(), {"--jobs", "1"}));
  ToroluxProcess second(study(kPlan, folder.path(), {"--jobs", "1"}));
  std::size_t started = 0;
  for (ToroluxProcess* process : {&first, &second}) {
    const Finished end = process->wait();
    EXPECT_EQ(end.exit_code, 0) << end.errors;
    std::istringstream words(end.errors.substr(end.errors.find("there, ") + 7));
    std::size_t own = 0;
    words >> own;
    started += own;
  }
  EXPECT_EQ(started, kRuns);
  EXPECT_EQ(outputs_of(folder.path()), undisturbed());
}

TEST(Study, CommandsRunByHandLeaveItsResults) {
  const TemporaryFolder folder;
  const Finished printed = run_torolux(study(kPlan, folder.path(), {"--print-commands"}));
  EXPECT_EQ(std::ranges::count(printed.output, '\n'), static_cast<std::ptrdiff_t>(kRuns));
  const std::string script = folder.path() / "commands.sh";
  std::ofstream(script) << printed.output;
  ASSERT_EQ(std::system(("sh " + script + " > /dev/null").c_str()), 0);
  EXPECT_THAT(run_torolux(study(kPlan, folder.path())).errors, HasSubstr("50 were there, 0 started, 0 failed"));
  EXPECT_EQ(outputs_of(folder.path()), undisturbed());
}

TEST(Study, ADryRunRunsNothing) {
  const TemporaryFolder folder;
  const fs::path results = folder.path() / "results";
  const Finished dry = run_torolux(study(kPlan, results, {"--dry-run"}));
  EXPECT_EQ(dry.exit_code, 0);
  EXPECT_EQ(std::ranges::count(dry.output, '\n'), static_cast<std::ptrdiff_t>(kRuns));
  EXPECT_THAT(dry.output, HasSubstr("pes=4x4, machine.torus.flit_bytes=1, machine.torus.link_cycles=10\n"));
  EXPECT_FALSE(fs::exists(results));
}

/// Of a plan with one run, what --print-commands says: it names the key.
std::string command_of(const fs::path& folder, const std::string& more, const std::string& elf = image("hello")) {
  std::ofstream(folder / "one.toml") << "[base]\ncommand = 'run'\nimage = '" << elf << "'\n" << more;
  const Finished printed = run_torolux(study(folder / "one.toml", folder / "results", {"--print-commands"}));
  EXPECT_EQ(printed.exit_code, 0) << printed.errors;
  return printed.output.substr(printed.output.find("--stats"));
}

TEST(Study, AKeyChangesWithWhatDeterminesTheRunAndWithNothingElse) {
  const TemporaryFolder folder;
  const std::string key = command_of(folder.path(), "");
  EXPECT_EQ(command_of(folder.path(), ""), key);
  EXPECT_EQ(command_of(folder.path(), "pes = '4x4'\n"), key) << "what is built in, given";
  EXPECT_EQ(command_of(folder.path(), "machine.torus.flit_bytes = 16\nthreads = 2\n"), key);
  EXPECT_EQ(command_of(folder.path(), "pe-memory = '1024K'\n"), key) << "another spelling";
  std::ofstream(folder.path() / "machine.toml") << "[torus]\nflit_bytes = 16\n";
  EXPECT_EQ(command_of(folder.path(), "machine = 'machine.toml'\n"), key);
  const std::string wider = command_of(folder.path(), "machine.torus.flit_bytes = 32\n");
  EXPECT_NE(wider, key);
  std::ofstream(folder.path() / "machine.toml") << "[torus]\nflit_bytes = 32\n";
  EXPECT_EQ(command_of(folder.path(), "machine = 'machine.toml'\n"), wider) << "a machine file counts by what it says";
  EXPECT_NE(command_of(folder.path(), "pes = '2x2'\n"), key);
  const std::string moved = folder.path() / "moved.elf";
  fs::copy_file(image("hello"), moved);
  EXPECT_EQ(command_of(folder.path(), "", moved), key) << "the same image elsewhere";
  std::ofstream(moved, std::ios::app) << '\0';
  EXPECT_NE(command_of(folder.path(), "", moved), key) << "another image";
}

TEST(Study, EqualPointsRunOnce) {
  const TemporaryFolder folder;
  const std::string plan = folder.path() / "plan.toml";
  std::ofstream(plan) << "[base]\ncommand = 'run'\nimage = '" << image("hello")
                      << "'\npes = '1x1'\n[vary_one]\npes = ['1x1', '2x1']\nmachine.torus.flit_bytes = [16, 32]\n";
  const Finished run = run_torolux(study(plan, folder.path() / "results", {"--format", "markdown"}));
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_THAT(run.errors, HasSubstr("5 points, 3 different runs: 0 were there, 3 started"));
  EXPECT_THAT(run.output, HasSubstr("| base |"));
  EXPECT_THAT(run.output, HasSubstr("| pes | 2x1 |"));
  EXPECT_THAT(run.output, HasSubstr("| machine.torus.flit_bytes | 32 |"));
}

TEST(Study, AFailedRunIsToldAndTheOthersGoOn) {
  const TemporaryFolder folder;
  const std::string plan = folder.path() / "plan.toml";
  std::ofstream(plan) << "[base]\ncommand = 'run'\nimage = '" << image("token")
                      << "'\n[vary]\nmachine.processor.most_cycles_between_hints = [1000, 2000000000]\n"
                         "pes = ['1x1', '2x2']\n[report]\ny = 'cycles'\n";
  const Finished run = run_torolux(study(plan, folder.path() / "results"));
  EXPECT_EQ(run.exit_code, 3);
  EXPECT_THAT(run.errors, HasSubstr("failed with exit code 3"));
  EXPECT_THAT(run.errors, HasSubstr("--set processor.most_cycles_between_hints=1000"));
  EXPECT_THAT(run.errors, HasSubstr("missing"));
  const std::string table = contents(folder.path() / "results" / "results.csv");
  EXPECT_EQ(std::ranges::count(table, '\n'), 5);
  EXPECT_THAT(table, HasSubstr("\n1000,1x1,,,"));
  EXPECT_THAT(contents(folder.path() / "results" / "cycles.svg"), HasSubstr("runs missing)"));
}

// Each plan has its folder and its table under its name; the second is done though the first has a run that fails.
TEST(Study, SeveralPlansAreDoneOneAfterTheOther) {
  const TemporaryFolder folder;
  const auto plan = [&folder](const std::string& name, const std::string& limit) {
    const std::string file = folder.path() / (name + ".toml");
    std::ofstream(file) << "[base]\ncommand = 'run'\nimage = '" << image("token")
                        << "'\n[vary]\nmachine.processor.most_cycles_between_hints = [" << limit
                        << ", 2000000000]\n[report]\ny = 'cycles'\n";
    return file;
  };
  const std::vector<std::string> plans = {plan("first", "1000"), plan("second", "1900000000")};
  const Finished run = run_torolux({"study", plans[0], plans[1], "--format", "markdown"});
  EXPECT_EQ(run.exit_code, 3);
  for (const char* name : {"first", "second"}) {
    EXPECT_THAT(run.output, HasSubstr(std::string("/") + name + ".toml\n\n| "));
    EXPECT_TRUE(fs::exists(folder.path() / (std::string(name) + ".study") / "results.csv")) << name;
  }
  EXPECT_EQ(run_torolux({"study", plans[0], plans[1], "--folder", folder.path() / "both"}).exit_code, 1);
  EXPECT_EQ(run_torolux({"study", plans[0], plans[1], "--format", "csv"}).exit_code, 1);
}

}  // namespace
}  // namespace torolux::test
