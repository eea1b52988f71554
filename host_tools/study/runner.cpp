// SPDX-License-Identifier: MIT
// A pool of child processes.
#include "host_tools/study/runner.hpp"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <deque>
#include <iostream>
#include <list>
#include <thread>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/files/shell_line.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/study/child.hpp"
#include "host_tools/study/claim.hpp"
#include "host_tools/study/options.hpp"

namespace torolux::study {
namespace {

using Clock = std::chrono::steady_clock;

/// A run may take milliseconds; or hours, and then nobody waits for a twentieth of a second.
constexpr std::chrono::milliseconds kShortestPause{1}, kLongestPause{50};

class Pool {
 public:
  Pool(std::vector<Work> work, const ResultFolder& folder, const RunnerChoice& choice)
      : folder_(folder), choice_(choice), pending_(work.begin(), work.end()) {
    std::ranges::stable_sort(pending_, std::greater<>(), [](const Work& w) { return w.run.work; });
  }

  RunnerEnd run() {
    std::chrono::milliseconds pause = kShortestPause;
    while (!pending_.empty() || !running_.empty() || !claimed_.empty()) {
      if (interrupted()) return stopped();
      const bool changed = start_some();
      pause = reap() || changed ? kShortestPause : std::min(2 * pause, kLongestPause);
      show_life();
      std::this_thread::sleep_for(pause);
      if (pending_.empty()) pending_.swap(claimed_);
    }
    return std::move(end_);
  }

 private:
  struct Running {
    Work work;
    std::vector<std::string> words;
    Claim claim;
    Child child;
  };

  bool start_some() {
    bool changed = false;
    while (running_.size() < choice_.jobs && !pending_.empty()) {
      Work work = std::move(pending_.front());
      pending_.pop_front();
      changed = start(std::move(work)) || changed;
    }
    return changed;
  }

  bool start(Work work) {
    std::optional<Claim> claim = Claim::take(folder_.lock(work.run.key));
    if (!claim) {
      claimed_.push_back(std::move(work));
      return false;
    }
    // Whoever had the lock before may have done it.
    if (folder_.read(work.run)) {
      ++end_.others;
      return true;
    }
    std::vector<std::string> words = words_for_result(work.run, folder_, choice_.threads);
    Child child("/proc/" + std::to_string(::getpid()) + "/exe", words);  // this one, should it have been replaced
    claim->note_child(child.process());
    running_.push_back({std::move(work), std::move(words), std::move(*claim), std::move(child)});
    ++end_.started;
    return true;
  }

  bool reap() {
    bool changed = false;
    for (auto running = running_.begin(); running != running_.end();) {
      const std::optional<Ended> ended = running->child.poll();
      if (!ended) {
        ++running;
        continue;
      }
      finish(*running, *ended);
      running = running_.erase(running);
      changed = true;
    }
    return changed;
  }

  void finish(Running& running, const Ended& ended) {
    const KeyedRun& run = running.work.run;
    if (ended.exit_code == 0 && folder_.from_output()) write_file(folder_.file(run.key), ended.output);
    std::string errors = ended.errors;
    if (ended.exit_code == 0) {
      try {
        if (folder_.read(run)) return;
        errors = "it ended well and left no result\n";
      } catch (const InputError& error) {
        std::filesystem::remove(folder_.file(run.key));
        errors = std::string(error.what()) + ": scene, image or firmware have changed since the study began\n";
      }
    }
    if (interrupted()) return;
    running.words.insert(running.words.begin(), choice_.program);
    end_.failures.push_back({running.work.label, shell_line(running.words), ended.exit_code, errors});
    const Failure& failure = end_.failures.back();
    std::cerr << "torolux: " << failure.label << ": failed with exit code " << failure.exit_code << "\n  "
              << failure.command << "\n"
              << failure.errors << std::flush;
  }

  void show_life() {
    if (Clock::now() - shown_ < kHeartbeat) return;
    shown_ = Clock::now();
    for (const Running& running : running_) running.claim.show_life();
  }

  RunnerEnd stopped() {
    for (const Running& running : running_) running.child.signal(SIGTERM);
    for (Running& running : running_) running.child.wait();
    end_.interrupted = true;
    return std::move(end_);
  }

  const ResultFolder& folder_;
  const RunnerChoice& choice_;
  std::deque<Work> pending_, claimed_;
  std::list<Running> running_;
  RunnerEnd end_;
  Clock::time_point shown_ = Clock::now();
};

}  // namespace

RunnerEnd run_all(std::vector<Work> work, const ResultFolder& folder, const RunnerChoice& choice) {
  return Pool(std::move(work), folder, choice).run();
}

}  // namespace torolux::study
