// SPDX-License-Identifier: MIT
// Proves with the real mpirun: a render or run whose PEs other ranks run leaves the bytes of one process, whatever
// ranks, threads and placing, also with a rank on a slower core, and goes on from its checkpoint anywhere; where a rank
// is lost, the run ends with nothing half done. Skipped where there is no MPI.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <thread>

#include "tests/machine/mpi_run.hpp"
#include "tests/machine/process.hpp"
#include "tests/support/golden_sort.hpp"
#include "tests/support/temporary_folder.hpp"

namespace torolux::test {
namespace {

using std::chrono_literals::operator""ms;
using std::chrono_literals::operator""s;
using testing::HasSubstr;
using testing_support::TemporaryFolder;

class MpiRender : public testing::Test {
 protected:
  void SetUp() override {
    if (!fs::exists(kMpirun)) GTEST_SKIP() << "this build has no MPI";
  }

  TemporaryFolder alone_, folder_;
};

std::vector<std::string> small_render(const fs::path& folder, const std::vector<std::string>& more = {}) {
  std::vector<std::string> words = small_render_options();
  words.insert(words.begin(), {"render", TOROLUX_SOURCE_DIR "/scenes/cornell_box"});
  words.insert(words.end(), {"--output", (folder / "a.pfm").string(), "--stats", (folder / "a.json").string()});
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

TEST_F(MpiRender, ARenderOnRanksLeavesTheSameBytes) {
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

/// Runs sort.elf as golden_sort.hpp says; returns its trace hash.
std::uint64_t hash_of_sort(unsigned ranks, const std::string& threads, const std::string& placing) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / "a.json";
  const std::string pes = std::to_string(kGoldenColumns) + "x" + std::to_string(kGoldenRows);
  std::vector<std::string> words = {"run",       std::string(TOROLUX_FIRMWARE_DIR) + "/sort.elf",
                                    "--engine",  "interpreted",
                                    "--pes",     pes,
                                    "--placing", placing,
                                    "--stats",   file.string(),
                                    "--threads", threads,
                                    "--"};
  words.insert(words.end(), kGoldenArguments.begin(), kGoldenArguments.end());
  const study::Ended run = mpirun(ranks, words).wait();
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  EXPECT_EQ(folder.files(), 1U) << "no rank writes a file of its own";
  return std::stoull(statistics(file).at("trace_hash").get<std::string>(), nullptr, 16);
}

// All combinations: ranks_images_test.
TEST_F(MpiRender, AnImageOnRanksHasTheGoldenTraceHash) {
  EXPECT_EQ(hash_of_sort(1, "2", "block"), kGoldenTraceHash);
  EXPECT_EQ(hash_of_sort(14, "1", "random"), kGoldenTraceHash) << "more ranks than PEs";
  EXPECT_EQ(hash_of_sort(2, "2", "block"), kGoldenTraceHash);
  EXPECT_EQ(hash_of_sort(3, "1", "cyclic"), kGoldenTraceHash);
  EXPECT_EQ(hash_of_sort(5, "2", "random"), kGoldenTraceHash);
}

/// Long enough that a signal which follows its first checkpoint comes before its end.
std::vector<std::string> longer_render(const fs::path& folder) {
  return small_render(folder, {"--max-shots", "120", "--size", "64x64"});
}

struct Started {
  study::Child run;
  std::vector<pid_t> processes;  ///< of each rank, or the one; empty: something was not there in time
};

/// A render on three ranks, or in one process, that has just kept its state for the first time.
Started start_until_kept(bool on_ranks, const fs::path& folder) {
  const fs::path kept = folder / "a.ckpt";
  std::vector<std::string> words = longer_render(folder);
  words.insert(words.end(), {"--checkpoint", kept.string(), "--checkpoint-minutes", "0.0001"});
  constexpr unsigned ranks = 3;
  Started started{on_ranks ? mpirun(ranks, words) : study::Child(torolux_file().string(), words), {}};
  const auto deadline = std::chrono::steady_clock::now() + 120s;
  const auto wait_for = [&](const auto& there) {
    while (!there() && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(1ms);
  };
  if (on_ranks) {
    for (unsigned rank = 0; rank < ranks; ++rank) {
      pid_t process = 0;
      wait_for([&] { return (process = process_of(rank, folder)) > 0; });
      started.processes.push_back(process);
    }
  } else {
    started.processes.push_back(started.run.process());
  }
  wait_for([&] { return fs::exists(kept); });
  if (!fs::exists(kept) || std::ranges::find(started.processes, 0) != started.processes.end()) {
    ADD_FAILURE() << "a rank has not begun, or its state was not kept";
    started.processes.clear();
  }
  return started;
}

/// Interrupts a render as soon as it has kept its state.
void interrupt_once_kept(bool on_ranks, const fs::path& folder) {
  Started started = start_until_kept(on_ranks, folder);
  if (!started.processes.empty()) ::kill(started.processes[0], SIGINT);
  EXPECT_EQ(started.run.wait().exit_code, 130);
  fs::remove(folder / "a.ckpt.png");  // where rays were traced already
  EXPECT_EQ(std::distance(fs::directory_iterator(folder), {}), 1) << "the checkpoint, and nothing beside it";
}

TEST_F(MpiRender, AnInterruptedRenderGoesOnOnAnotherNumberOfRanks) {
  const TemporaryFolder alone;
  ASSERT_EQ(run_torolux(longer_render(alone.path())).exit_code, 0);
  struct Change {
    bool saved_on_ranks;
    unsigned ranks;  // 1: without mpirun
  };
  for (const Change& change : {Change{true, 2}, Change{true, 5}, Change{true, 1}, Change{false, 3}}) {
    const TemporaryFolder folder;
    interrupt_once_kept(change.saved_on_ranks, folder.path());
    std::vector<std::string> words = longer_render(folder.path());
    words.insert(words.end(), {"--resume", (folder.path() / "a.ckpt").string()});
    if (change.ranks == 1) {
      ASSERT_EQ(run_torolux(words).exit_code, 0);
    } else {
      words.insert(words.end(), {"--placing", "random"});
      const study::Ended on_ranks = mpirun(change.ranks, words).wait();
      ASSERT_EQ(on_ranks.exit_code, 0) << on_ranks.errors;
    }
    EXPECT_EQ(folder.files(), 3U) << "no rank writes a file of its own";
    EXPECT_EQ(contents(folder.path() / "a.pfm"), contents(alone.path() / "a.pfm"));
    EXPECT_EQ(statistics(folder.path() / "a.json"), statistics(alone.path() / "a.json"));
  }
}

TEST_F(MpiRender, ARenderOnRanksTellsOnceWhatIsWrong) {
  const TemporaryFolder folder;
  const study::Ended traced =
      mpirun(2, small_render(folder.path(), {"--trace", (folder.path() / "t").string()})).wait();
  EXPECT_EQ(traced.exit_code, 1);
  EXPECT_THAT(traced.errors, HasSubstr("--trace does not go with PEs on other ranks"));
  const study::Ended memory = mpirun(2, small_render(folder.path(), {"--pe-memory", "128K"})).wait();
  EXPECT_EQ(memory.exit_code, 2);
  EXPECT_EQ(memory.errors.find("torolux: "), memory.errors.rfind("torolux: ")) << memory.errors;
}

/// A render on three ranks, of which one gets a signal once the state has been kept; and how it ends. Leaves the
/// checkpoint, and no process.
study::Ended end_of_disturbed_render(const fs::path& folder, int signal) {
  Started started = start_until_kept(true, folder);
  if (!started.processes.empty()) ::kill(started.processes[1], signal);
  study::Ended end = started.run.wait();
  EXPECT_TRUE(all_gone(started.processes));
  EXPECT_FALSE(fs::exists(folder / "a.pfm"));
  EXPECT_FALSE(fs::exists(folder / "a.json"));
  return end;
}

void expect_goes_on(const fs::path& folder) {
  const TemporaryFolder alone;
  ASSERT_EQ(run_torolux(longer_render(alone.path())).exit_code, 0);
  std::vector<std::string> words = longer_render(folder);
  words.insert(words.end(), {"--resume", (folder / "a.ckpt").string()});
  const study::Ended on = mpirun(2, words).wait();
  ASSERT_EQ(on.exit_code, 0) << on.errors;
  EXPECT_EQ(contents(folder / "a.pfm"), contents(alone.path() / "a.pfm"));
  EXPECT_EQ(statistics(folder / "a.json"), statistics(alone.path() / "a.json"));
}

TEST_F(MpiRender, AStoppedRankWithPesEndsARenderAndIsNamed) {
  const study::Ended end = end_of_disturbed_render(folder_.path(), SIGSTOP);
  EXPECT_EQ(end.exit_code, 3) << end.errors;
  EXPECT_THAT(end.errors, HasSubstr("torolux: rank 1 ("));
  EXPECT_THAT(end.errors, HasSubstr("counts as lost"));
  EXPECT_EQ(folder_.files(), 1U) << "the checkpoint";
  expect_goes_on(folder_.path());
}

// The launcher ends all ranks, and says so.
TEST_F(MpiRender, AKilledRankWithPesEndsARenderWhichGoesOnWhenStartedAgain) {
  const study::Ended end = end_of_disturbed_render(folder_.path(), SIGKILL);
  EXPECT_NE(end.exit_code, 0);
  EXPECT_NE(end.output + end.errors, "");
  expect_goes_on(folder_.path());
}

TEST_F(MpiRender, ARankOnASlowerCoreLeavesTheSameBytes) {
  const TemporaryFolder alone;
  ASSERT_EQ(run_torolux(small_render(alone.path())).exit_code, 0);
  std::vector<std::string> words = small_render(folder_.path());
  words.insert(words.end(), {":", "-n", "1", "nice", "-n", "5", torolux_file().string()});
  const std::vector<std::string> same = small_render(folder_.path());
  words.insert(words.end(), same.begin(), same.end());
  std::jthread busy([](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
    }
  });
  const study::Ended end = mpirun(2, words).wait();
  ASSERT_EQ(end.exit_code, 0) << end.errors;
  EXPECT_EQ(contents(folder_.path() / "a.pfm"), contents(alone.path() / "a.pfm"));
  EXPECT_EQ(statistics(folder_.path() / "a.json"), statistics(alone.path() / "a.json"));
}

}  // namespace
}  // namespace torolux::test
