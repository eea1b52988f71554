// SPDX-License-Identifier: MIT
// Proves with the real mpirun: a study on several ranks leaves the bytes of one that runs alone; a rank that is stopped
// is named and loses only its run; where a rank is killed, no half output is left, and the study goes on when started
// again. A render whose PEs other ranks run leaves the bytes of one process. Skipped where there is no MPI.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <iterator>
#include <map>
#include <thread>

#include "host_tools/study/child.hpp"
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
const std::string kMpirun = TOROLUX_MPIRUN;

fs::path torolux_file() {
  return fs::read_symlink("/proc/self/exe").parent_path() / "torolux";
}

/// Root in a container, and more ranks than cores: OpenMPI wants to be told that this is meant.
study::Child mpirun(unsigned ranks, const std::vector<std::string>& words) {
  std::vector<std::string> all = {"OMPI_ALLOW_RUN_AS_ROOT=1",
                                  "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1",
                                  "OMPI_MCA_rmaps_base_oversubscribe=1",
                                  kMpirun,
                                  "-n",
                                  std::to_string(ranks),
                                  torolux_file().string()};
  all.insert(all.end(), words.begin(), words.end());
  return {"env", all};
}

study::Child farm(unsigned ranks, const fs::path& folder) {
  return mpirun(ranks, {"study", kPlan, "--folder", folder.string(), "--format", "csv"});
}

std::map<std::string, std::string> outputs_of(const fs::path& folder) {
  std::map<std::string, std::string> outputs;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() != ".json") outputs[entry.path().filename()] = contents(entry.path());
  }
  return outputs;
}

std::size_t results_in(const fs::path& folder) {
  std::size_t count = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error)) count += entry.path().extension() == ".json" ? 1 : 0;
  return count;
}

/// Of a process that may have ended meanwhile, or be somebody else's: then empty.
std::string text_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// The process of rank 1 that works on this folder; 0: there is none.
pid_t first_helper(const fs::path& folder) {
  for (const auto& entry : fs::directory_iterator("/proc")) {
    const std::string environment = '\0' + text_of(entry.path() / "environ");
    const bool first = environment.find(std::string("\0OMPI_COMM_WORLD_RANK=1\0", 24)) != std::string::npos ||
                       environment.find(std::string("\0PMI_RANK=1\0", 12)) != std::string::npos;
    const std::string words = text_of(entry.path() / "cmdline");
    if (first && words.find(folder.string()) != std::string::npos && words.starts_with(torolux_file().string()))
      return static_cast<pid_t>(std::stol(entry.path().filename()));
  }
  return 0;
}

/// Sends rank 1 a signal as soon as a tenth of the results is there.
void disturb(const fs::path& folder, int number) {
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (results_in(folder) < 5 && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(1ms);
  const pid_t helper = first_helper(folder);
  ASSERT_GT(helper, 0);
  ::kill(helper, number);
}

class MpiStudy : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kMpirun)) GTEST_SKIP() << "this build has no MPI";
    const Finished run = run_torolux({"study", kPlan, "--folder", alone_.path(), "--format", "csv"});
    ASSERT_EQ(run.exit_code, 0) << run.errors;
    output_ = run.output;
    errors_ = run.errors;
  }

  TemporaryFolder alone_, folder_;
  std::string output_, errors_;
};

TEST_F(MpiStudy, LeavesTheSameBytesOnAnyNumberOfRanks) {
  for (const unsigned ranks : {1U, 2U, 5U}) {
    const TemporaryFolder folder;
    const study::Ended run = farm(ranks, folder.path()).wait();
    EXPECT_EQ(run.exit_code, 0) << run.errors;
    EXPECT_EQ(run.output, output_) << ranks;
    EXPECT_THAT(run.errors, HasSubstr(errors_));
    EXPECT_EQ(outputs_of(folder.path()), outputs_of(alone_.path())) << ranks;
    EXPECT_EQ(results_in(folder.path()), results_in(alone_.path()));
  }
}

TEST_F(MpiStudy, AStoppedRankIsNamedAndTheOthersGoOn) {
  study::Child run = farm(3, folder_.path());
  disturb(folder_.path(), SIGSTOP);
  const study::Ended end = run.wait();
  EXPECT_EQ(end.exit_code, 0) << end.errors;
  EXPECT_THAT(end.errors, HasSubstr("torolux: rank 1 ("));
  EXPECT_THAT(end.errors, HasSubstr("counts as lost"));
  EXPECT_EQ(outputs_of(folder_.path()), outputs_of(alone_.path()));
}

TEST_F(MpiStudy, AKilledRankLeavesNoHalfOutputAndTheStudyGoesOnWhenStartedAgain) {
  study::Child run = farm(3, folder_.path());
  disturb(folder_.path(), SIGKILL);
  const study::Ended end = run.wait();
  EXPECT_NE(end.exit_code, 0);
  EXPECT_FALSE(fs::exists(folder_.path() / "results.csv"));
  EXPECT_GE(results_in(folder_.path()), 5U);
  const study::Ended again = farm(3, folder_.path()).wait();
  EXPECT_EQ(again.exit_code, 0) << again.errors;
  EXPECT_EQ(outputs_of(folder_.path()), outputs_of(alone_.path()));
}

TEST_F(MpiStudy, WhatIsWrongIsToldOnce) {
  const study::Ended usage = mpirun(3, {"study", "--nonsense"}).wait();
  EXPECT_EQ(usage.exit_code, 1);
  EXPECT_EQ(usage.errors.find("--nonsense"), usage.errors.rfind("--nonsense")) << usage.errors;
  const study::Ended input = mpirun(3, {"study", "missing.toml"}).wait();
  EXPECT_EQ(input.exit_code, 2);
  EXPECT_THAT(input.errors, HasSubstr("torolux: missing.toml"));
  const study::Ended info = mpirun(2, {"info", "cornell_box"}).wait();
  EXPECT_EQ(info.exit_code, 1);
  EXPECT_THAT(info.errors, HasSubstr("mpirun would run 'info' 2 times"));
}

// ---- PEs on other ranks ----

std::vector<std::string> small_render(const fs::path& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = small_render_options();
  words.insert(words.begin(), {"render", TOROLUX_SOURCE_DIR "/scenes/cornell_box"});
  words.insert(words.end(), {"--output", (folder / "a.pfm").string(), "--stats", (folder / "a.json").string()});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST_F(MpiStudy, ARenderOnRanksLeavesTheSameBytes) {
  const TemporaryFolder alone;
  const Finished run = run_torolux(small_render(alone.path()));
  ASSERT_EQ(run.exit_code, 0) << run.errors;
  for (const unsigned ranks : {2U, 3U}) {
    const TemporaryFolder folder;
    const study::Ended on_ranks = mpirun(ranks, small_render(folder.path(), {"--placing", "cyclic"})).wait();
    ASSERT_EQ(on_ranks.exit_code, 0) << on_ranks.errors;
    EXPECT_EQ(folder.files(), 2U) << "no rank writes a file of its own";
    EXPECT_EQ(contents(folder.path() / "a.pfm"), contents(alone.path() / "a.pfm"));
    EXPECT_EQ(statistics(folder.path() / "a.json"), statistics(alone.path() / "a.json"));
  }
}

TEST_F(MpiStudy, ARenderOnRanksTellsOnceWhatIsWrong) {
  const TemporaryFolder folder;
  const study::Ended traced =
      mpirun(2, small_render(folder.path(), {"--trace", (folder.path() / "t").string()})).wait();
  EXPECT_EQ(traced.exit_code, 1);
  EXPECT_THAT(traced.errors, HasSubstr("--trace does not go with PEs on other ranks"));
  const study::Ended memory = mpirun(2, small_render(folder.path(), {"--pe-memory", "128K"})).wait();
  EXPECT_EQ(memory.exit_code, 2);
  EXPECT_EQ(memory.errors.find("torolux: "), memory.errors.rfind("torolux: ")) << memory.errors;
}

TEST_F(MpiStudy, AStoppedRankWithPesEndsARenderAndIsNamed) {
  const TemporaryFolder folder;
  study::Child run = mpirun(3, {"render", TOROLUX_SOURCE_DIR "/scenes/cornell_box", "--pes", "8x8", "--quality", "fine",
                                "--output", (folder.path() / "a.pfm").string()});
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  pid_t helper = 0;
  while (helper == 0 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(100ms);
    helper = first_helper(folder.path());
  }
  ASSERT_GT(helper, 0);
  std::this_thread::sleep_for(1s);
  ::kill(helper, SIGSTOP);
  const study::Ended end = run.wait();
  EXPECT_EQ(end.exit_code, 3) << end.errors;
  EXPECT_THAT(end.errors, HasSubstr("torolux: rank 1 ("));
  EXPECT_THAT(end.errors, HasSubstr("counts as lost"));
  EXPECT_EQ(folder.files(), 0U);
}

// As with mpirun, by a build without MPI or one whose mpirun this is not.
TEST(RanksWithoutMpi, AreRefusedOnce) {
  const auto start = [](const char* rank) {
    return study::Child("env", {"PMI_SIZE=2", std::string("PMI_RANK=") + rank, torolux_file().string(), "info", "x"})
        .wait();
  };
  const study::Ended first = start("0");
  EXPECT_EQ(first.exit_code, 1);
  EXPECT_THAT(first.errors, HasSubstr("mpirun would run 'info' 2 times"));
  const study::Ended second = start("1");
  EXPECT_EQ(second.exit_code, 1);
  EXPECT_EQ(second.errors, "");
}

}  // namespace
}  // namespace torolux::test
