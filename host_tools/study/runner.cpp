// SPDX-License-Identifier: MIT
// A pool of runs: what is to be done, what is being done by whom.
#include "host_tools/study/runner.hpp"

#include <algorithm>
#include <chrono>
#include <deque>
#include <iostream>
#include <map>
#include <thread>

#include "emulator/errors.hpp"
#include "host_tools/cli/command.hpp"
#include "host_tools/files/shell_line.hpp"
#include "host_tools/files/write_file.hpp"
#include "host_tools/study/child.hpp"
#include "host_tools/study/claim.hpp"

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
      pause = collect() || changed ? kShortestPause : std::min(2 * pause, kLongestPause);
      show_life();
      std::this_thread::sleep_for(pause);
      if (pending_.empty()) pending_.swap(claimed_);
    }
    return std::move(end_);
  }

 private:
  struct Running {
    Work work;
    Claim claim;
  };

  bool start_some() {
    bool changed = false;
    for (Hands* hands : choice_.hands) {
      while (hands->free() && !pending_.empty()) {
        Work work = std::move(pending_.front());
        pending_.pop_front();
        changed = start(std::move(work), *hands) || changed;
      }
    }
    return changed;
  }

  bool start(Work work, Hands& hands) {
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
    std::vector<std::string> words = hands.brings_results()
                                         ? words_for_result(work.run, folder_, choice_.threads, kResultStream)
                                         : words_for_result(work.run, folder_, choice_.threads);
    const std::optional<pid_t> process = hands.start({next_, std::move(words), folder_.from_output()});
    if (process) claim->note_child(*process);
    running_.emplace(next_++, Running{std::move(work), std::move(*claim)});
    ++end_.started;
    return true;
  }

  bool collect() {
    bool changed = false;
    for (Hands* hands : choice_.hands) {
      while (const std::optional<Answer> answer = hands->poll()) {
        const auto running = running_.find(answer->number);
        if (running == running_.end()) continue;  // somebody else's by now, or of a study before this one
        if (answer->outcome) {
          finish(running->second.work, *answer->outcome);
        } else {
          pending_.push_front(std::move(running->second.work));
          --end_.started;
        }
        running_.erase(running);
        changed = true;
      }
    }
    return changed;
  }

  void finish(const Work& work, const Outcome& outcome) {
    const KeyedRun& run = work.run;
    if (outcome.exit_code == 0 && !outcome.result.empty()) write_file(folder_.file(run.key), outcome.result);
    std::string errors = outcome.errors;
    if (outcome.exit_code == 0) {
      try {
        if (folder_.read(run)) return;
        errors = "it ended well and left no result\n";
      } catch (const InputError& error) {
        std::filesystem::remove(folder_.file(run.key));
        errors = std::string(error.what()) + ": scene, image or firmware have changed since the study began\n";
      }
    }
    if (interrupted()) return;
    std::vector<std::string> words = words_for_result(run, folder_, choice_.threads);
    words.insert(words.begin(), choice_.program);
    end_.failures.push_back({work.label, shell_line(words), outcome.exit_code, errors});
    const Failure& failure = end_.failures.back();
    std::cerr << "torolux: " << failure.label << ": failed with exit code " << failure.exit_code << "\n  "
              << failure.command << "\n"
              << failure.errors << std::flush;
  }

  void show_life() {
    if (Clock::now() - shown_ < kHeartbeat) return;
    shown_ = Clock::now();
    for (const auto& [number, running] : running_) running.claim.show_life();
  }

  RunnerEnd stopped() {
    for (Hands* hands : choice_.hands) hands->stop();
    end_.interrupted = true;
    return std::move(end_);
  }

  const ResultFolder& folder_;
  const RunnerChoice& choice_;
  std::deque<Work> pending_, claimed_;
  std::map<std::uint64_t, Running> running_;  ///< by the number of the order
  inline static std::uint64_t next_ = 0;      ///< never used twice: answers may come after their study's end
  RunnerEnd end_;
  Clock::time_point shown_ = Clock::now();
};

}  // namespace

RunnerEnd run_all(std::vector<Work> work, const ResultFolder& folder, const RunnerChoice& choice) {
  return Pool(std::move(work), folder, choice).run();
}

}  // namespace torolux::study
