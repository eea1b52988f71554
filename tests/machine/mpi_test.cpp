// SPDX-License-Identifier: MIT
// Proves with the real mpirun: a study on several ranks leaves the bytes of one that runs alone; a rank that is stopped
// is named and loses only its run; where a rank is killed, no half output is left, and the study goes on when started
// again. Skipped where there is no MPI.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <csignal>
#include <map>
#include <thread>

#include "tests/machine/mpi_run.hpp"
#include "tests/machine/process.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using testing::HasSubstr;
using testing_support::TemporaryFolder;

const std::string kPlan = TOROLUX_SOURCE_DIR "/tests/data/studies/token.toml";
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

/// Sends rank 1 a signal as soon as a tenth of the results is there.
void disturb(const fs::path& folder, int number) {
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (results_in(folder) < 5 && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(1ms);
  const pid_t helper = process_of(1, folder);
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
