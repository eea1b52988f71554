// SPDX-License-Identifier: MIT
// Ctrl-C as a flag, so that a run can end its PEs and leave no half-written file.
#pragma once

#include <array>
#include <csignal>

namespace torolux {

/// What was interrupted had nothing more to do: interrupted() is false again.
void forget_interruption();

/// SIGINT, SIGTERM and SIGHUP end this process at once, as if there were no guard; for the rest of the guard's life.
void end_by_signals();

/// While it lives, the first SIGINT, SIGTERM or SIGHUP only sets the flag that interrupted() reads; a second of the
/// same kind ends the process at once, whatever it computes. A full disk, a file size limit or a closed pipe is an
/// error of the write, not a death by signal. Puts everything back at the end.
class InterruptionGuard {
 public:
  InterruptionGuard();
  InterruptionGuard(const InterruptionGuard&) = delete;
  InterruptionGuard& operator=(const InterruptionGuard&) = delete;
  ~InterruptionGuard();

 private:
  static constexpr std::array<int, 5> kSignals = {SIGINT, SIGTERM, SIGHUP, SIGXFSZ, SIGPIPE};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace torolux
