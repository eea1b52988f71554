// SPDX-License-Identifier: MIT
// No processes and no clocks: events and a wait status.
#include "host_tools/launch/verdict.hpp"

#include <sys/wait.h>

#include <csignal>
#include <cstring>

#include "emulator/errors.hpp"
#include "emulator/ranks/launched.hpp"
#include "host_tools/files/shell_line.hpp"

namespace torolux::launch {
namespace {

constexpr int kFailure = static_cast<int>(ExitCode::machine_failure);

std::string how_it_died(int status) {
  if (WIFEXITED(status)) return "it ended with exit code " + std::to_string(WEXITSTATUS(status)) + " without a word";
  const int number = WTERMSIG(status);
  return "it died of signal " + std::to_string(number) + " (" + ::strsignal(number) + ")" +
         (number == SIGKILL ? ": somebody has killed it, or this computer has too little memory" : "");
}

}  // namespace

void Verdict::take(const RankEvent& event) {
  switch (event.kind) {
    case RankEvent::Kind::begins:
      here_[event.rank].process = event.process;
      return;
    case RankEvent::Kind::ends:
      here_[event.rank].has_ended = true;
      // Of the others only a failure counts, and one that rank 0 has not told: it may be the last that hears of it.
      if (event.rank == 0 ? exit_code_ && !of_rank_0_ : exit_code_ || event.status == 0) return;
      exit_code_ = event.status;
      of_rank_0_ = event.rank == 0;
      return;
    case RankEvent::Kind::died:
    case RankEvent::Kind::keeper_gone:
      if (!settled() && !here_[event.rank].has_ended) lose(event);
  }
}

void Verdict::lose(const RankEvent& event) {
  const pid_t of_rank = here_[event.rank].process;
  exit_code_ = kFailure;
  lost_ = "rank " + std::to_string(event.rank) + " (" + ranks::host_name() + ", process " +
          std::to_string(of_rank > 0 ? of_rank : event.process) +
          ") is lost: " + (event.kind == RankEvent::Kind::died ? how_it_died(event.status) : "its keeper was killed");
}

void Verdict::ask_to_end() {
  asked_ = asked_ || !exit_code_;
}

void Verdict::interrupt() {
  interrupted_ = !exit_code_;
}

int Verdict::exit_code(int launcher, const std::vector<std::string>& command) const {
  if (asked_ && (!lost_.empty() || !exit_code_)) throw Interrupted("");
  if (!lost_.empty()) {
    const bool all_here = here_.size() == ranks_;
    throw MachineFailure(
        lost_ +
        (all_here ? ""
                  : "; unless the launcher ended it because a rank on another computer was lost, and says so above") +
        "; all ranks have been ended");
  }
  if (interrupted_) throw Interrupted("");
  if (exit_code_) return *exit_code_;
  // Rank 0 is on another computer, or was never started.
  if (WIFEXITED(launcher) && !here_.contains(0) && WEXITSTATUS(launcher) == 0) return 0;
  blame_launcher(launcher, command);
}

std::string Verdict::note(int launcher) const {
  if (asked_ && !lost_.empty())
    return lost_ + ", before rank 0 had ended: the state is that of the last checkpoint before, if there is one";
  if (!exit_code_ && !asked_ && !interrupted_ && here_.empty() && WIFEXITED(launcher) && WEXITSTATUS(launcher) == 0)
    return "no rank has begun on this computer: if the launcher has not run them on others, but only queued them, say, "
           "the results are not there yet";
  return "";
}

void Verdict::blame_launcher(int status, const std::vector<std::string>& command) const {
  const std::string end = WIFSIGNALED(status) ? "signal " + std::to_string(WTERMSIG(status))
                                              : "exit code " + std::to_string(WEXITSTATUS(status));
  const std::string what = here_.empty() ? "no rank has begun on this computer" : "rank 0 has not said how it ends";
  throw MachineFailure("the launcher ended with " + end + ", and " + what + "; it was " + shell_line(command));
}

}  // namespace torolux::launch
