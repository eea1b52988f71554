// SPDX-License-Identifier: MIT
// Ctrl-C as a flag, so that a run can end its PEs and leave no half-written file.
#pragma once

#include <array>
#include <csignal>

namespace torolux {

/// What was interrupted had nothing more to do: interrupted() is false again.
void forget_interruption();

/// What a second signal of the same kind does.
enum class SecondSignal {
  ends,    ///< the process at once, whatever it computes
  nothing  ///< one signal may come by several ways, and somebody else ends this process where it is to be at once
};

/// While it lives, the first SIGINT, SIGTERM or SIGHUP only sets the flag that interrupted() reads. A full disk, a file
/// size limit or a closed pipe is an error of the write, not a death by signal. Puts everything back at the end.
class InterruptionGuard {
 public:
  explicit InterruptionGuard(SecondSignal second = SecondSignal::ends);
  InterruptionGuard(const InterruptionGuard&) = delete;
  InterruptionGuard& operator=(const InterruptionGuard&) = delete;
  ~InterruptionGuard();

 private:
  static constexpr std::array<int, 5> kSignals = {SIGINT, SIGTERM, SIGHUP, SIGXFSZ, SIGPIPE};
  std::array<struct sigaction, kSignals.size()> before_{};
};

}  // namespace torolux
