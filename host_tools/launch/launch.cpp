// SPDX-License-Identifier: MIT
// One loop over what ranks say, what the user wants, and whether the launcher still runs.
#include "host_tools/launch/launch.hpp"

#include <chrono>
#include <csignal>
#include <filesystem>
#include <iostream>
#include <set>

#include "host_tools/launch/launcher_process.hpp"
#include "host_tools/launch/orphans.hpp"
#include "host_tools/launch/rank_links.hpp"
#include "host_tools/launch/signal_file.hpp"
#include "host_tools/launch/verdict.hpp"

namespace torolux::launch {
namespace {

using Clock = std::chrono::steady_clock;

/// The launcher's end is looked for so often.
constexpr std::chrono::milliseconds kLook{50};
/// So long a launcher may take to end ranks: where the run has failed (OpenMPI takes 1 s; without a connection to
/// another computer it waits for ever), and where rank 0 has done its work.
constexpr std::chrono::milliseconds kAfterFailure{1500}, kAfterWork{8000};
/// Told to end, for itself and ranks on other computers. A rank counts as lost after 8 s: all is over after 10.
constexpr std::chrono::milliseconds kToldToEnd{500};

class Watch {
 public:
  Watch(const LaunchChoice& choice, std::vector<std::string> command)
      : command_(std::move(command)),
        launcher_(command_, launch_environment(links_.name()), signals_.before()),
        verdict_(choice.ranks) {
    links_.wake_by(signals_.descriptor());
  }

  int run() {
    while (!launcher_.poll()) {
      listen(kLook);
      while (const std::optional<int> signal = signals_.take()) pass_on(*signal);
      if (!settled_ && verdict_.settled()) settled_ = Clock::now();
      if (settled_ && Clock::now() - *settled_ > (verdict_.failed() ? kAfterFailure : kAfterWork)) end_all();
    }
    end_rest();
    const int status = *launcher_.poll();
    if (const std::string note = verdict_.note(status); !note.empty()) std::cerr << "torolux: note: " << note << "\n";
    return verdict_.exit_code(status, command_);
  }

 private:
  void listen(std::chrono::milliseconds limit) {
    for (const RankEvent& event : links_.wait(limit)) verdict_.take(event);
  }

  /// As to a single process: the first of a kind asks it to end in order, the second ends it.
  void pass_on(int signal) {
    const std::optional<pid_t> first = links_.process_of(0);
    if (heard_.insert(signal).second && first) {
      verdict_.ask_to_end();
      ::kill(*first, signal);
      return;
    }
    verdict_.interrupt();
    end_all();
  }

  void end_all() {
    launcher_.signal(SIGTERM);
    kill_ranks();
    const Clock::time_point end = Clock::now() + kToldToEnd;
    while (!launcher_.poll() && Clock::now() < end) listen(kLook);
    launcher_.kill_group();
    while (!launcher_.poll()) listen(kLook);
  }

  /// What launchers leave behind: ranks, where one was killed itself, and what ranks had started.
  void end_rest() {
    listen({});  // also what was said last
    const Clock::time_point end = Clock::now() + kToldToEnd;
    while (!links_.processes().empty()) {
      listen(kLook);
      if (Clock::now() > end) kill_ranks();
    }
    orphans_.end();
  }

  void kill_ranks() const {
    for (const pid_t process : links_.processes()) ::kill(process, SIGKILL);
  }

  SignalFile signals_;  // first: blocked before there is anything that they could tear
  Orphans orphans_;
  RankLinks links_;
  std::vector<std::string> command_;
  LauncherProcess launcher_;
  Verdict verdict_;
  std::set<int> heard_;
  std::optional<Clock::time_point> settled_;
};

}  // namespace

int run_ranks(const LaunchChoice& choice, const std::vector<std::string>& words) {
  ::signal(SIGCHLD, SIG_DFL);  // ignored by a parent, it would let no end of a child be seen
  const std::string program = std::filesystem::read_symlink("/proc/self/exe").string();
  return Watch(choice, launch_words(choice, program, words)).run();
}

}  // namespace torolux::launch
