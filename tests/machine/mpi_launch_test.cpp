// SPDX-License-Identifier: MIT
// Proves with the real mpirun: `--ranks N` starts ranks that leave the bytes of one process; whichever of them is
// killed, and however, the run ends with exit code 3, names it and leaves nothing; signals to the one that was started
// do what they do to a single process. Skipped where there is no MPI.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <thread>

#include "host_tools/files/write_file.hpp"
#include "tests/machine/mpi_run.hpp"
#include "tests/machine/process.hpp"
#include "tests/support/golden_sort.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using testing::EndsWith;
using testing::HasSubstr;
using testing_support::TemporaryFolder;

constexpr unsigned kRanks = 3;

std::vector<std::string> render(const fs::path& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = small_render_options();
  words.insert(words.begin(), {"render", TOROLUX_SOURCE_DIR "/scenes/cornell_box"});
  words.insert(words.end(), {"--quiet", "--max-shots", "120", "--size", "64x64"});
  words.insert(words.end(), {"--output", (folder / "a.pfm").string(), "--stats", (folder / "a.json").string()});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

/// A render on three ranks of its own that has begun to compute.
struct Launched {
  study::Child run;
  std::vector<RankProcesses> ranks;

  std::vector<pid_t> all() const {
    std::vector<pid_t> processes;
    for (const RankProcesses& one : ranks) processes.insert(processes.end(), {one.keeper, one.rank});
    return processes;
  }
  bool there() const {
    const std::vector<pid_t> processes = all();
    return processes.size() == std::size_t{2} * kRanks && std::ranges::find(processes, 0) == processes.end();
  }
};

void wait_for(const std::function<bool()>& there) {
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(120);
  while (!there() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
}

/// It keeps its state in a.ckpt, and has done so once.
Launched start(const fs::path& folder) {
  const fs::path kept = folder / "a.ckpt";
  Launched launched{
      study::Child(torolux_file().string(), render(folder, {"--ranks", std::to_string(kRanks), "--checkpoint",
                                                            kept.string(), "--checkpoint-minutes", "0.0001"})),
      {}};
  wait_for([&] { return fs::exists(kept); });
  for (unsigned rank = 0; rank < kRanks; ++rank) launched.ranks.push_back(rank_and_keeper(rank, folder));
  EXPECT_TRUE(fs::exists(kept) && launched.there()) << "a rank has not begun, or its state was not kept";
  return launched;
}

std::string last_line(const std::string& text) {
  const std::size_t end = text.find_last_not_of('\n');
  return text.substr(text.rfind('\n', end) + 1, end - text.rfind('\n', end));
}

class MpiLaunch : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kMpirun)) GTEST_SKIP() << "this build has no MPI";
  }

  /// Nothing but a checkpoint, which is whole.
  void expect_nothing_half_done(const Launched& launched) {
    EXPECT_EQ(std::ranges::count_if(launched.all(), runs), 0) << "processes that are left";
    fs::remove(folder_.path() / "a.ckpt.png");  // where rays were traced already
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), {}), 1) << "the checkpoint, and nothing beside it";
  }
  void expect_goes_on() {
    const TemporaryFolder alone;
    ASSERT_EQ(run_torolux(render(alone.path())).exit_code, 0);
    const Finished on =
        run_torolux(render(folder_.path(), {"--ranks", "2", "--resume", (folder_.path() / "a.ckpt").string()}));
    ASSERT_EQ(on.exit_code, 0) << on.errors;
    EXPECT_EQ(contents(folder_.path() / "a.pfm"), contents(alone.path() / "a.pfm"));
    EXPECT_EQ(statistics(folder_.path() / "a.json"), statistics(alone.path() / "a.json"));
  }

  TemporaryFolder folder_;
};

TEST_F(MpiLaunch, RanksOfItsOwnLeaveTheBytesOfOneProcess) {
  const TemporaryFolder alone;
  ASSERT_EQ(run_torolux(render(alone.path(), {"--ranks", "1", "--launcher", "/nowhere"})).exit_code, 0)
      << "one rank needs no launcher";
  // As users with a launcher of their own give it; root in a container, and more ranks than cores.
  const std::string launcher =
      "env OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1 " + kMpirun;
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--ranks", "3"}, {"--ranks=2", "--launcher", launcher, "--placing", "cyclic"}}) {
    const TemporaryFolder folder;
    const Finished run = run_torolux(render(folder.path(), more));
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(run.errors, "");
    EXPECT_EQ(folder.files(), 2U);
    EXPECT_EQ(contents(folder.path() / "a.pfm"), contents(alone.path() / "a.pfm"));
    EXPECT_EQ(statistics(folder.path() / "a.json"), statistics(alone.path() / "a.json"));
  }
}

TEST_F(MpiLaunch, AnImageOnRanksOfItsOwnHasTheGoldenTraceHash) {
  const fs::path file = folder_.path() / "a.json";
  std::vector<std::string> words = {"run", std::string(TOROLUX_FIRMWARE_DIR) + "/sort.elf", "--engine", "interpreted"};
  words.insert(words.end(), {"--pes", std::to_string(kGoldenColumns) + "x" + std::to_string(kGoldenRows)});
  words.insert(words.end(), {"--stats", file.string(), "--ranks", "4", "--"});
  words.insert(words.end(), kGoldenArguments.begin(), kGoldenArguments.end());
  const Finished run = run_torolux(words);
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(std::stoull(statistics(file).at("trace_hash").get<std::string>(), nullptr, 16), kGoldenTraceHash);
}

struct Death {
  unsigned rank;
  int signal;
  bool of_keeper;
};

class MpiLaunchDeath : public MpiLaunch, public testing::WithParamInterface<Death> {};

TEST_P(MpiLaunchDeath, EndsTheRunWhichNamesTheRank) {
  const Death death = GetParam();
  Launched launched = start(folder_.path());
  ASSERT_TRUE(launched.there());
  const RankProcesses& struck = launched.ranks[death.rank];
  ::kill(death.of_keeper ? struck.keeper : struck.rank, death.signal);
  const study::Ended end = launched.run.wait();
  EXPECT_EQ(end.exit_code, 3) << end.errors;
  EXPECT_THAT(last_line(end.errors), HasSubstr("torolux: rank " + std::to_string(death.rank) + " ("));
  EXPECT_THAT(last_line(end.errors), HasSubstr(", process " + std::to_string(struck.rank) + ") is lost: "));
  expect_nothing_half_done(launched);
  if (death.rank == 1) expect_goes_on();
}

INSTANTIATE_TEST_SUITE_P(OfAnyRank, MpiLaunchDeath,
                         testing::Values(Death{0, SIGKILL, false}, Death{1, SIGKILL, false}, Death{2, SIGKILL, false},
                                         Death{0, SIGABRT, false}, Death{1, SIGSEGV, false}, Death{2, SIGALRM, false},
                                         Death{0, SIGKILL, true}, Death{2, SIGKILL, true}),
                         [](const testing::TestParamInfo<Death>& one) {
                           return "rank" + std::to_string(one.param.rank) + "_signal" +
                                  std::to_string(one.param.signal) + (one.param.of_keeper ? "_keeper" : "");
                         });

TEST_F(MpiLaunch, AStoppedRankEndsTheRunAndIsNamed) {
  Launched launched = start(folder_.path());
  ASSERT_TRUE(launched.there());
  ::kill(launched.ranks[1].rank, SIGSTOP);
  const study::Ended end = launched.run.wait();
  EXPECT_EQ(end.exit_code, 3) << end.errors;
  EXPECT_THAT(end.errors, HasSubstr("torolux: rank 1 ("));
  EXPECT_THAT(end.errors, HasSubstr("counts as lost"));
  expect_nothing_half_done(launched);
}

TEST_F(MpiLaunch, CtrlCSavesTheStateAndAnotherNumberOfRanksGoesOn) {
  Launched launched = start(folder_.path());
  ASSERT_TRUE(launched.there());
  launched.run.signal(SIGINT);
  const study::Ended end = launched.run.wait();
  EXPECT_EQ(end.exit_code, 130) << end.errors;
  EXPECT_THAT(end.errors, EndsWith("torolux: interrupted\n"));
  EXPECT_EQ(end.errors.find("torolux: interrupted"), end.errors.rfind("torolux: interrupted")) << "told once";
  expect_nothing_half_done(launched);
  expect_goes_on();
}

// Of a batch system: its word comes by several ways.
TEST_F(MpiLaunch, ASignalToEveryProcessSavesTheState) {
  Launched launched = start(folder_.path());
  ASSERT_TRUE(launched.there());
  for (const pid_t process : launched.all()) ::kill(process, SIGTERM);
  launched.run.signal(SIGTERM);
  const study::Ended end = launched.run.wait();
  EXPECT_EQ(end.exit_code, 130) << end.errors;
  EXPECT_EQ(last_line(end.errors), "torolux: interrupted");
  EXPECT_EQ(end.errors.find("is lost"), std::string::npos) << end.errors;
  expect_nothing_half_done(launched);
  expect_goes_on();
}

// As nohup leaves SIGHUP, some parents SIGCHLD, and a shell that has made a torolux of itself what runs behind it.
TEST_F(MpiLaunch, WhatWasThereBeforeStaysAsItWas) {
  const fs::path background = folder_.path() / "background", output = folder_.path() / "output";
  fs::create_directory(output);
  std::vector<std::string> words = {"-c", "sleep 600 & echo $! > \"$0\"; exec env --ignore-signal=CHLD,HUP \"$@\"",
                                    background.string(), torolux_file().string()};
  const std::vector<std::string> own = render(output, {"--ranks", "3"});
  words.insert(words.end(), own.begin(), own.end());
  study::Child run("sh", words);
  wait_for([&] { return rank_and_keeper(0, output).rank != 0; });
  run.signal(SIGHUP);
  const study::Ended end = run.wait();
  EXPECT_EQ(end.exit_code, 0) << end.errors;
  const auto sleeper = static_cast<pid_t>(std::stol(text_of(background)));
  EXPECT_TRUE(runs(sleeper));
  ::kill(sleeper, SIGKILL);
}

TEST_F(MpiLaunch, WithoutACheckpointASignalEndsARunThatLeavesNothing) {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    study::Child run(torolux_file().string(), render(folder_.path(), {"--ranks", "3"}));
    std::vector<pid_t> processes;
    wait_for([&] {
      processes.clear();
      for (unsigned rank = 0; rank < kRanks; ++rank) processes.push_back(rank_and_keeper(rank, folder_.path()).rank);
      return std::ranges::find(processes, 0) == processes.end();
    });
    run.signal(signal);
    EXPECT_EQ(run.wait().exit_code, 130) << signal;
    EXPECT_EQ(std::ranges::count_if(processes, runs), 0);
    EXPECT_EQ(folder_.files(), 0U);
  }
}

TEST_F(MpiLaunch, ASecondCtrlCEndsAllAtOnce) {
  Launched launched = start(folder_.path());
  ASSERT_TRUE(launched.there());
  for (const RankProcesses& one : launched.ranks) ::kill(one.rank, SIGSTOP);  // the first does nothing
  launched.run.signal(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(200));  // two that wait are one
  launched.run.signal(SIGINT);
  const study::Ended end = launched.run.wait();
  EXPECT_EQ(end.exit_code, 130) << end.errors;
  EXPECT_THAT(end.errors, EndsWith("torolux: interrupted\n"));
  expect_nothing_half_done(launched);
}

TEST_F(MpiLaunch, WhereTheStarterOrTheLauncherIsKilledNoRankStays) {
  Launched alone = start(folder_.path());
  ASSERT_TRUE(alone.there());
  alone.run.signal(SIGKILL);
  EXPECT_EQ(alone.run.wait().exit_code, 128 + SIGKILL);
  EXPECT_TRUE(all_gone(alone.all()));
  fs::remove(folder_.path() / "a.ckpt");
  Launched launched = start(folder_.path());
  ASSERT_TRUE(launched.there());
  ::kill(children_of(launched.run.process()).at(0), SIGKILL);
  const study::Ended end = launched.run.wait();
  EXPECT_EQ(end.exit_code, 3) << end.errors;
  EXPECT_TRUE(all_gone(launched.all()));
}

TEST_F(MpiLaunch, AStudyOnRanksOfItsOwnHasTheSameResults) {
  const std::string plan = TOROLUX_SOURCE_DIR "/tests/data/studies/token.toml";
  const TemporaryFolder alone;
  const Finished one = run_torolux({"study", plan, "--folder", alone.path(), "--format", "csv"});
  ASSERT_EQ(one.exit_code, 0) << one.errors;
  const Finished run = run_torolux({"study", plan, "--folder", folder_.path(), "--format", "csv", "--ranks", "3"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(run.output, one.output);
  EXPECT_EQ(run.errors, one.errors);
}

// Its run has nobody to give its result to.
TEST_F(MpiLaunch, AKilledRankOfAStudyIsNamedAndItsRunEnded) {
  const fs::path plan = folder_.path() / "plan.toml";
  write_file(plan, std::string("[base]\ncommand = \"render\"\nscene = \"") + TOROLUX_SOURCE_DIR +
                       "/scenes/cornell_box\"\n[vary]\nseed = [1, 2, 3, 4, 5, 6]\n");
  study::Child study(torolux_file().string(), {"study", plan, "--ranks", "3"});
  RankProcesses struck;
  std::vector<pid_t> its_runs;
  wait_for([&] {
    struck = rank_and_keeper(1, folder_.path());
    its_runs = children_of(struck.rank);
    return struck.rank != 0 && !its_runs.empty();
  });
  ASSERT_EQ(its_runs.size(), 1U);
  ::kill(struck.rank, SIGKILL);
  const study::Ended end = study.wait();
  EXPECT_EQ(end.exit_code, 3) << end.errors;
  EXPECT_THAT(last_line(end.errors), HasSubstr("torolux: rank 1 ("));
  EXPECT_FALSE(runs(its_runs[0]));
}

TEST_F(MpiLaunch, WhatIsWrongIsToldInOneLine) {
  const auto expect = [&](const std::vector<std::string>& more, int code, const std::string& text) {
    const Finished run = run_torolux(render(folder_.path(), more));
    EXPECT_EQ(run.exit_code, code) << run.errors;
    EXPECT_THAT(last_line(run.errors), HasSubstr("torolux: " + text));
    EXPECT_EQ(run.errors.find("torolux: "), run.errors.rfind("torolux: ")) << run.errors;
  };
  expect({"--ranks", "2", "--trace", (folder_.path() / "t").string()}, 1,
         "--trace does not go with PEs on other ranks");
  expect({"--ranks", "2", "--pe-memory", "128K"}, 2, "");
  expect({"--ranks", "2", "--launcher", "/nowhere"}, 2, "/nowhere: the launcher cannot be started: No such file");
  expect({"--ranks", "2", "--launcher", "true"}, 0, "note: no rank has begun on this computer");
  expect({"--ranks", "2", "--launcher", "false"}, 3, "the launcher ended with exit code 1, and no rank has begun");
  const study::Ended twice = mpirun(2, render(folder_.path(), {"--ranks", "2"})).wait();
  EXPECT_EQ(twice.exit_code, 1);
  EXPECT_THAT(twice.errors, HasSubstr("torolux: --ranks starts ranks, and mpirun has done so"));
  EXPECT_EQ(folder_.files(), 0U);
}

TEST(RanksOption, IsRefusedInABuildWithoutMpi) {
  if (fs::exists(kMpirun)) GTEST_SKIP() << "this build has MPI";
  for (const std::vector<std::string>& more : {std::vector<std::string>{}, {"--launcher", "true"}}) {
    std::vector<std::string> words = {"render", "cornell_box", "--ranks", "2"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished run = run_torolux(words);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.errors, HasSubstr("--ranks: this torolux was built without MPI; install mpi-default-dev"));
  }
}

TEST(RanksOption, IsANumberOfRanksAndNeedsNoLauncherAlone) {
  for (const std::vector<std::string>& more :
       {std::vector<std::string>{"--ranks", "0"}, {"--ranks", "-1"}, {"--ranks", "many"}, {"--launcher", "mpirun"}}) {
    std::vector<std::string> words = {"render", "cornell_box"};
    words.insert(words.end(), more.begin(), more.end());
    const Finished run = run_torolux(words);
    EXPECT_EQ(run.exit_code, 1);
    EXPECT_THAT(run.errors, HasSubstr(more[0]));
  }
}

}  // namespace
}  // namespace torolux::test
