// SPDX-License-Identifier: MIT
// `torolux run` on each engine as a user sees it: the same result whatever the computer does meanwhile, messages and
// exit codes for what goes wrong, and nothing left behind.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/machine/process.hpp"

namespace torolux::test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::string image(const std::string& name) {
  return (std::filesystem::path(TOROLUX_FIRMWARE_DIR) / (name + ".elf")).string();
}

/// A name in the temporary folder; the file, if any, is removed at the end.
class TemporaryName {
 public:
  explicit TemporaryName(const std::string& name)
      : path_(std::filesystem::temp_directory_path() / ("torolux-" + std::to_string(getpid()) + "-" + name)) {}
  TemporaryName(const TemporaryName&) = delete;
  TemporaryName& operator=(const TemporaryName&) = delete;
  ~TemporaryName() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  std::string text() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

/// Keeps all cores busy while it lives.
class Load {
 public:
  Load() {
    for (unsigned i = 0; i < 2 * std::max(1U, std::thread::hardware_concurrency()); ++i) {
      threads_.emplace_back([this] {
        while (!end_.load(std::memory_order_relaxed)) {
        }
      });
    }
  }
  ~Load() {
    end_ = true;
    for (std::thread& thread : threads_) thread.join();
  }
  Load(const Load&) = delete;
  Load& operator=(const Load&) = delete;

 private:
  std::atomic<bool> end_ = false;
  std::vector<std::thread> threads_;
};

/// What the PEs say and all statistics but host times.
std::string result_of(const std::string& image_name, const std::string& pes, std::vector<std::string> more = {}) {
  const TemporaryName stats("stats.json");
  std::vector<std::string> arguments = {"run", image(image_name), "--pes", pes, "--stats", stats.text()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  const Finished run = run_torolux(arguments);
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  std::ifstream stream(stats.text());
  nlohmann::ordered_json json = nlohmann::ordered_json::parse(stream);
  json.erase("engine");
  for (const char* key : {"engine", "qemu_pes"}) json["settings"].erase(key);
  json.erase("command_line");
  json.erase("wall_seconds");
  json.erase("host");
  return run.output + json.dump();
}

TEST(Run, HelloFromEveryPe) {
  const Finished run = run_torolux({"run", image("hello"), "--pes", "2x2"});
  EXPECT_EQ(run.exit_code, 0) << run.errors;
  for (int pe = 0; pe < 4; ++pe) {
    EXPECT_THAT(run.output, HasSubstr(": Hello from PE " + std::to_string(pe) + " of 4\n"));
  }
  EXPECT_THAT(run.errors, HasSubstr("4 PEs halted"));
}

TEST(Run, QuietLeavesOnlyWhatThePesSay) {
  const Finished run = run_torolux({"run", image("hello"), "--pes", "1x1", "--quiet"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_THAT(run.output, testing::MatchesRegex("PE 0 @ [0-9]+: Hello from PE 0 of 1\n"));
  EXPECT_EQ(run.errors, "");
}

class Token : public testing::TestWithParam<const char*> {};

TEST_P(Token, TakesTheSameCyclesWhateverTheComputerDoes) {
  const std::string first = result_of("token", GetParam(), {"--engine", "qemu"});
  EXPECT_THAT(first, HasSubstr("The token has passed "));
  EXPECT_EQ(result_of("token", GetParam(), {"--engine", "qemu", "--threads", "1"}), first) << "QEMU on one core";
  const auto expect_same = [&](const char* how) {
    for (const char* threads : {"1", "2", "3"}) {
      EXPECT_EQ(result_of("token", GetParam(), {"--engine", "translated", "--threads", threads}), first)
          << threads << " threads, " << how;
    }
  };
  expect_same("once");
  expect_same("repeated");
  const Load load;
  EXPECT_EQ(result_of("token", GetParam(), {"--engine", "qemu"}), first) << "QEMU on a busy computer";
  expect_same("on a busy computer");
}

INSTANTIATE_TEST_SUITE_P(Sizes, Token, testing::Values("4x4", "3x5", "9x8"));

TEST(Run, FourThousandPesStartAndHalt) {
  const Finished run = run_torolux({"run", image("hello"), "--pes", "64x64", "--engine", "translated"});
  EXPECT_EQ(run.exit_code, 0);
  EXPECT_EQ(std::ranges::count(run.output, '\n'), 4096);
  EXPECT_THAT(run.errors, HasSubstr("4096 PEs halted"));
}

/// A PATH without any program, as long as it lives.
class EmptyPath {
 public:
  EmptyPath() { setenv("PATH", "/nonexistent", 1); }  // NOLINT(concurrency-mt-unsafe): one thread
  EmptyPath(const EmptyPath&) = delete;
  EmptyPath& operator=(const EmptyPath&) = delete;
  ~EmptyPath() { setenv("PATH", path_.c_str(), 1); }  // NOLINT(concurrency-mt-unsafe)

 private:
  std::string path_ = std::getenv("PATH");  // NOLINT(concurrency-mt-unsafe)
};

TEST(Run, InterpretedNeedsNoCompilerAndIsTheSame) {
  const std::string translated = result_of("token", "3x2", {"--engine", "translated"});
  const EmptyPath no_compiler;
  EXPECT_EQ(result_of("token", "3x2", {"--engine", "interpreted"}), translated);
}

TEST(Run, TheMachineFileChangesTheCycles) {
  const TemporaryName machine("machine.toml");
  std::ofstream(machine.text()) << "[torus]\nlink_cycles = 20\n";
  EXPECT_NE(result_of("token", "2x2", {"--machine", machine.text()}), result_of("token", "2x2"));
}

// ---- What goes wrong: in `faults`, the number of rows says what. ----

class Fault : public testing::TestWithParam<const char*> {
 protected:
  static Finished run(const std::string& pes, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments = {"run", image("faults"), "--engine", GetParam(), "--pes", pes};
    arguments.insert(arguments.end(), more.begin(), more.end());
    Finished finished = run_torolux(arguments);
    EXPECT_EQ(finished.exit_code, 3);
    return finished;
  }
};
INSTANTIATE_TEST_SUITE_P(Engines, Fault, testing::Values("qemu", "translated"));

TEST_P(Fault, ATrapNamesPeCauseAndPlace) {
  const Finished end = run("1x6");
  EXPECT_THAT(end.errors, testing::ContainsRegex(
                              "PE [0-5]: trap: illegal instruction at pc 0x800[0-9a-f]+ \\([A-Za-z_].*\\), mtval 0x"));
}

TEST_P(Fault, ThePeHasNoDoublePrecision) {
  const Finished end = run("1x9");
  EXPECT_THAT(end.errors, HasSubstr("illegal instruction"));
  EXPECT_THAT(end.errors, HasSubstr("mtval 0x02c5f553"));
}

TEST_P(Fault, AnEndlessLoopEndsTheRun) {
  const TemporaryName machine("machine.toml");
  std::ofstream(machine.text()) << "[processor]\nmost_cycles_between_hints = 1_000_000\n";
  const Finished end = run("1x10", {"--machine", machine.text()});
  EXPECT_THAT(end.errors, testing::ContainsRegex("PE [0-9]: no HINT for more than [0-9]+ cycles, now at pc "
                                                 "0x[0-9a-f]+ \\(torolux::.*\\): an endless loop\\?"));
}

TEST_P(Fault, PesThatWaitForEverAreNamed) {
  const Finished end = run("1x11");
  EXPECT_THAT(end.errors, HasSubstr("11 PEs still wait to receive: PE 0, 1, 2"));
}

TEST_P(Fault, AnUnknownHintIsAFault) {
  const Finished end = run("1x12");
  EXPECT_THAT(end.errors, HasSubstr("HINT unknown to the NIU"));
  EXPECT_THAT(end.errors, HasSubstr("2000"));
}

TEST(Run, BadInputAndBadUsageHaveTheirExitCodes) {
  const Finished no_elf = run_torolux({"run", "/proc/self/status"});
  EXPECT_EQ(no_elf.exit_code, 2);
  EXPECT_THAT(no_elf.errors, HasSubstr("/proc/self/status"));
  EXPECT_EQ(run_torolux({"run", "/nowhere.elf"}).exit_code, 2);
  EXPECT_THAT(run_torolux({"run", "/tmp"}).errors, HasSubstr("/tmp: cannot be read: Is a directory"));
  const TemporaryName pipe("pipe");
  ASSERT_EQ(::mkfifo(pipe.text().c_str(), 0600), 0);
  EXPECT_THAT(run_torolux({"run", pipe.text()}).errors, HasSubstr("is a pipe or a device"));
  EXPECT_EQ(run_torolux({"run", image("hello"), "--machine", "/nowhere.toml"}).exit_code, 2);
  EXPECT_EQ(run_torolux({"run", image("hello"), "--stats", "/nowhere/stats.json"}).exit_code, 2);
  EXPECT_EQ(run_torolux({"run", image("hello"), "--engine", "abacus"}).exit_code, 1);
  EXPECT_EQ(run_torolux({"run"}).exit_code, 1);
  EXPECT_EQ(run_torolux({"run", image("hello"), "--pes", "two"}).exit_code, 1);
}

// ---- Ends from outside ----

/// Ten PEs in endless loops that no limit stops.
class EndlessRun : public testing::Test {
 protected:
  EndlessRun() : machine_("endless.toml") {
    std::ofstream(machine_.text()) << "[processor]\nmost_cycles_between_hints = 1_000_000_000_000_000\n";
  }
  void start(const std::vector<std::string>& more) {
    std::vector<std::string> arguments = {"run", image("faults"), "--pes", "1x10", "--machine", machine_.text()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    run_.emplace(arguments);
  }

  TemporaryName machine_;
  std::optional<ToroluxProcess> run_;
};

class EndlessRunOnThreads : public EndlessRun, public testing::WithParamInterface<const char*> {};

TEST_P(EndlessRunOnThreads, CtrlCEndsTheTranslatedEngine) {
  start({"--engine", "translated", "--threads", GetParam()});
  std::this_thread::sleep_for(std::chrono::milliseconds(500));
  run_->signal(SIGINT);
  const Finished end = run_->wait();
  EXPECT_EQ(end.exit_code, 130);
  EXPECT_THAT(end.errors, HasSubstr("interrupted"));
}
INSTANTIATE_TEST_SUITE_P(Threads, EndlessRunOnThreads, testing::Values("1", "2"));

class EndlessRunOnQemu : public EndlessRun {
 protected:
  EndlessRunOnQemu() {
    start({"--engine", "qemu"});
    qemus_ = run_->children(10);
  }
  void SetUp() override { ASSERT_EQ(qemus_.size(), 10U); }

  std::vector<pid_t> qemus_;
};

TEST_F(EndlessRunOnQemu, AKilledQemuIsNamedWithinTwoSeconds) {
  const auto begin = std::chrono::steady_clock::now();
  ASSERT_EQ(kill(qemus_[7], SIGKILL), 0);
  const Finished end = run_->wait();
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(2));
  EXPECT_EQ(end.exit_code, 3);
  EXPECT_THAT(end.errors, HasSubstr("PE 7: its QEMU process was killed by signal 9"));
  EXPECT_TRUE(all_gone(qemus_));
}

TEST_F(EndlessRunOnQemu, CtrlCLeavesNothingBehind) {
  run_->signal(SIGINT);
  const Finished end = run_->wait();
  EXPECT_EQ(end.exit_code, 130);
  EXPECT_THAT(end.errors, HasSubstr("interrupted"));
  EXPECT_TRUE(all_gone(qemus_));
}

TEST_F(EndlessRunOnQemu, AKilledEmulatorTakesItsQemusAlong) {
  run_->signal(SIGKILL);
  EXPECT_EQ(run_->wait().exit_code, 128 + SIGKILL);
  EXPECT_TRUE(all_gone(qemus_));
}

}  // namespace
}  // namespace torolux::test
