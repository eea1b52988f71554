// SPDX-License-Identifier: MIT
// Proves with the real mpirun: a render or run whose PEs other ranks run leaves the bytes of one process, whatever
// ranks, threads and placing, also with a rank on a slower core, and goes on from its checkpoint anywhere; where a rank
// is lost, the run ends with nothing half done. Skipped where there is no MPI.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

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

TEST_F(MpiRender, AnImageOnRanksHasTheGoldenTraceHash) {
  EXPECT_EQ(hash_of_sort(1, "2", "block"), kGoldenTraceHash);
  EXPECT_EQ(hash_of_sort(14, "1", "random"), kGoldenTraceHash) << "more ranks than PEs";
  for (const unsigned ranks : {2U, 3U, 5U}) {
    for (const char* threads : {"1", "2"}) {
      for (const char* placing : {"block", "cyclic", "random"})
        EXPECT_EQ(hash_of_sort(ranks, threads, placing), kGoldenTraceHash)
            << ranks << " ranks, " << threads << " threads, " << placing;
    }
  }
}

/// Of some tenths of a second in one process, so that a signal that follows its first checkpoint comes in time.
std::vector<std::string> longer_render(const fs::path& folder) {
  return small_render(folder, {"--max-shots", "20", "--size", "32x32"});
}

/// Interrupts a render on three ranks, or in one process, as soon as it has kept its state for the first time.
void interrupt_once_kept(bool on_ranks, const fs::path& folder) {
  const fs::path kept = folder / "a.ckpt";
  std::vector<std::string> words = longer_render(folder);
  words.insert(words.end(), {"--checkpoint", kept.string(), "--checkpoint-minutes", "0.0001"});
  study::Child run = on_ranks ? mpirun(3, words) : study::Child(torolux_file().string(), words);
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (!fs::exists(kept) && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(1ms);
  ::kill(on_ranks ? process_of(0, folder) : run.process(), SIGINT);
  EXPECT_EQ(run.wait().exit_code, 130);
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

/// All processes of a run on ranks, once each of them is there.
std::vector<pid_t> processes_of(unsigned ranks, const fs::path& folder) {
  std::vector<pid_t> processes;
  for (unsigned rank = 0; rank < ranks; ++rank) {
    processes.push_back(process_of(rank, folder));
    EXPECT_GT(processes.back(), 0) << rank;
  }
  return processes;
}

/// A render on three ranks, of which one gets a signal once the state has been kept; and how it ends. Leaves the
/// checkpoint, and no process.
study::Ended end_of_disturbed_render(const fs::path& folder, int signal) {
  const fs::path kept = folder / "a.ckpt";
  std::vector<std::string> words = longer_render(folder);
  words.insert(words.end(), {"--checkpoint", kept.string(), "--checkpoint-minutes", "0.0001"});
  study::Child run = mpirun(3, words);
  const auto deadline = std::chrono::steady_clock::now() + 60s;
  while (!fs::exists(kept) && std::chrono::steady_clock::now() < deadline) std::this_thread::sleep_for(1ms);
  const std::vector<pid_t> processes = processes_of(3, folder);
  if (processes[1] > 0) ::kill(processes[1], signal);
  study::Ended end = run.wait();
  EXPECT_TRUE(all_gone(processes));
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
  words.insert(words.end(), {":", "-n", "1", "nice", "-n", "19", torolux_file().string()});
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
